#include <cmath>
#include <limits>

#include "compare/fit_terms.h"

namespace echocine::compare {

std::vector<OffsetCurve> offsetCurves(const FitMap& map, std::size_t structures) {
  std::vector<OffsetCurve> curves;
  const auto mean = [](double sum, double weight) {
    return weight > 0 ? sum / weight : std::numeric_limits<double>::quiet_NaN();
  };
  for (std::size_t s = 0; s < structures; ++s) {
    OffsetCurve curve{s, {}, {}, {}};
    bool seen = false;
    for (const std::vector<BoundaryOffset>& frame : map.boundary) {
      double weight = 0, offset = 0, distance = 0, tracked = 0, motion = 0;
      for (const BoundaryOffset& p : frame) {
        if (p.surface != s) continue;
        const double w = p.certainty, mm = p.offset_mm;
        weight += w, offset += w * mm, distance += w * std::abs(mm);
        if (p.motion_mm >= 0) tracked += 1, motion += static_cast<double>(p.motion_mm);
      }
      seen = seen || weight > 0;
      curve.offset_mm.push_back(mean(offset, weight));
      curve.distance_mm.push_back(mean(distance, weight));
      curve.motion_mm.push_back(mean(motion, tracked));
    }
    if (seen) curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace echocine::compare
