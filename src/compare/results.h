#pragma once
// What a comparison leaves in its folder.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "compare/compare.h"

namespace echocine::compare {

// `rms` and so on -> number; an infinite PSNR is null.
nlohmann::ordered_json metricsJson(const FrameMetrics& metrics);

// All numbers but the metrics of each frame.
nlohmann::ordered_json summaryJson(const Comparison& comparison);

// One row per real frame; the metrics end in _before and _after calibration, those of a band in
// _band_NAME.
std::string framesCsv(const Comparison& comparison);

// frames.csv, summary.json, compare.html, side_by_side.avi, sector_real.png and
// sector_synthetic.png; each is whole or absent, summary.json comes last. Throws JobError.
void writeResults(const Comparison& comparison, const CompareOptions& options,
                  const std::filesystem::path& folder);

}  // namespace echocine::compare
