#pragma once
// The files of a comparison.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "compare/compare.h"

namespace echocine::compare {

// `rms` etc. -> number; an infinite PSNR is null.
nlohmann::ordered_json metricsJson(const FrameMetrics& metrics);

// All numbers except the metrics of each frame.
nlohmann::ordered_json summaryJson(const Comparison& comparison);

// One row per real frame. The metrics end in _before and _after calibration, those of a band in
// _band_NAME.
std::string framesCsv(const Comparison& comparison);

// frames.csv, summary.json, compare.html, side_by_side.avi, sector_real.png and
// sector_synthetic.png. Each file is complete or absent; summary.json is written last. Throws
// JobError.
void writeResults(const Comparison& comparison, const CompareOptions& options,
                  const std::filesystem::path& folder);

}  // namespace echocine::compare
