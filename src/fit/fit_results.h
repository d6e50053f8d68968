#pragma once
// Output files of a fitted heart.

#include <filesystem>
#include <string>
#include <vector>

#include "fit/heart_fit.h"

namespace echocine::fit {

// fit.json: result, dials, views with poses, rivals, hints, assumptions. curves.csv: the volume of
// the left ventricle over the beat with its interval; in mL with a length scale, else relative to
// end-diastole. `labels`: of the loops, by view of the fit. Throws JobError.
void writeFit(const HeartFit& fit, const std::vector<std::string>& labels,
              const std::filesystem::path& folder);

// Assumptions of a fit, one sentence each.
std::vector<std::string> assumptionsOf(const HeartFit& fit);

}  // namespace echocine::fit
