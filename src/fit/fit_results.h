#pragma once
// Output files of a fitted heart.

#include <filesystem>
#include <initializer_list>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "fit/heart_fit.h"

namespace echocine::fit {

// Files of writeFit().
inline constexpr std::initializer_list<const char*> kFitFiles{"fit.json", "curves.csv", "fit.html"};

// fit.json: result, dials, views with poses, rivals, hints, assumptions. curves.csv: the volume of
// the left ventricle over the beat with its interval; in mL with a length scale, else relative to
// end-diastole. fit.html unless the fit was stopped: fit_page.h. `labels`: of the loops, by view of
// the fit. Throws JobError.
void writeFit(const HeartFit& fit, const std::vector<std::string>& labels,
              const std::filesystem::path& folder);

// The content of fit.json, and its text.
nlohmann::ordered_json fitJson(const HeartFit& fit, const std::vector<std::string>& labels);
std::string fitText(const HeartFit& fit, const std::vector<std::string>& labels);
// The text of curves.csv. Precondition: the fit has an ejection fraction.
std::string curvesCsv(const HeartFit& fit);
// The same for a page: {unit, phase, value, low, high}, lists of numbers.
nlohmann::ordered_json volumeJson(const HeartFit& fit);

// Assumptions of a fit, one sentence each.
std::vector<std::string> assumptionsOf(const HeartFit& fit);

}  // namespace echocine::fit
