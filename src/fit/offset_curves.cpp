#include <cmath>
#include <limits>
#include <optional>

#include "fit/fit_terms.h"
#include "truth/aha_segments.h"

namespace echocine::fit {

namespace {

// Curve over the points that belong to a part; none if no frame shows such a point.
template <typename Belongs>
std::optional<OffsetCurve> curveOf(const FitMap& map, std::size_t part, const Belongs& belongs) {
  const auto mean = [](double sum, double weight) {
    return weight > 0 ? sum / weight : std::numeric_limits<double>::quiet_NaN();
  };
  OffsetCurve curve{part, {}, {}, {}};
  double pieces = 0, certain = 0;
  bool seen = false;
  for (const std::vector<BoundaryOffset>& frame : map.boundary) {
    double weight = 0, offset = 0, distance = 0, tracked = 0, motion = 0;
    for (const BoundaryOffset& p : frame) {
      if (!belongs(p)) continue;
      const double w = p.certainty, mm = p.offset_mm;
      ++pieces, certain += w;
      weight += w, offset += w * mm, distance += w * std::abs(mm);
      if (p.motion_mm >= 0) tracked += 1, motion += static_cast<double>(p.motion_mm);
    }
    seen = seen || weight > 0;
    curve.offset_mm.push_back(mean(offset, weight));
    curve.distance_mm.push_back(mean(distance, weight));
    curve.motion_mm.push_back(mean(motion, tracked));
  }
  curve.pieces = mean(pieces, static_cast<double>(map.boundary.size()));
  curve.certainty = mean(certain, pieces);
  return seen ? std::optional(std::move(curve)) : std::nullopt;
}

}  // namespace

std::vector<OffsetCurve> offsetCurves(const FitMap& map, std::size_t structures) {
  std::vector<OffsetCurve> curves;
  for (std::size_t s = 0; s < structures; ++s)
    if (auto curve = curveOf(map, s, [&](const BoundaryOffset& p) { return p.surface == s; }))
      curves.push_back(std::move(*curve));
  return curves;
}

std::vector<OffsetCurve> segmentCurves(const FitMap& map) {
  std::vector<OffsetCurve> curves;
  for (std::size_t s = 1; s <= kAhaSegments; ++s)
    if (auto curve = curveOf(map, s, [&](const BoundaryOffset& p) { return p.segment == s; }))
      curves.push_back(std::move(*curve));
  return curves;
}

}  // namespace echocine::fit
