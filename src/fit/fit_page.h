#pragma once
// The page of a fitted heart.

#include <filesystem>
#include <string>
#include <vector>

#include "fit/heart_fit.h"

namespace echocine::fit {

// Offsets of a map minus those that the heart shows against its own rendered loop: the mean of a
// structure in a frame, 0 where the own loop does not show it. The rest is what the comparison
// itself does not explain.
FitMap beyondOwn(FitMap map, const FitReport& own);

// fit.html: loops with the heart drawn over them, disagreement and synthetic twins in step; the
// heart in 3-D; volume, dials, other hearts, hints and assumptions. Throws JobError.
void writeFitPage(const HeartFit& fit, const std::vector<std::string>& labels,
                  const std::filesystem::path& path);

}  // namespace echocine::fit
