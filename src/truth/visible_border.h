#pragma once
// Which points of a contour the picture shows: a border drops out where the wall is no brighter
// than what it borders.

#include <span>
#include <vector>

#include "scene/probe.h"
#include "truth/truth_values.h"

namespace echocine {

// A step between the two sides of a border below this is not seen. Our choice: about twice the
// standard deviation of the two means below, in speckle of 3 dB.
inline constexpr double kVisibleStep_dB = 3;

// One value per point of the contour, 1 if it is visible. `greys`: levels of the samples,
// line-major, linear in dB over `range_db`. The two sides are means over 6 mm along the contour,
// from 0.75 to 2.25 mm outside and from 1 to 3 mm inside; of a membrane, also of one that is cut in
// a ring, either side is compared with the sheet's own level, and both must be lower. Points
// outside the scan area are not visible.
std::vector<char> visiblePoints(const Contour& contour, bool membrane, const Probe& probe,
                                std::span<const float> greys, double range_db);

}  // namespace echocine
