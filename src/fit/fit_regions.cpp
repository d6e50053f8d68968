#include "fit/fit_regions.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "truth/aha_segments.h"

namespace echocine::fit {

namespace {

// Faint edges let the offset fall to 0, where that of the twins does not: standard deviations grow
// as certainty falls below this.
constexpr double kUsualCertainty = 0.4;
constexpr double kLeastCertainty = 0.1, kLeastPieces = 10,
                 kTiny = 1e-3;  // an outline of 12 mm; our choice

struct Summary {
  double offset = 0, motion = 0;  // mm
};

// Means over the frames that show the part; end-diastole and end-systole are a tenth of the beat
// either way. None if half of the frames, or either instant, does not show it.
std::optional<Summary> summaryOf(const std::vector<double>& offset_mm, double systole) {
  constexpr double kWithin = 0.1;  // of the beat; our choice
  double sum = 0, seen = 0, at[2] = {}, seen_at[2] = {};
  const auto n = static_cast<double>(offset_mm.size());
  for (std::size_t f = 0; f < offset_mm.size(); ++f) {
    if (!std::isfinite(offset_mm[f])) continue;
    sum += offset_mm[f], ++seen;
    for (int i = 0; i < 2; ++i)
      if (std::abs(std::remainder(static_cast<double>(f) / n - i * systole, 1)) <= kWithin + 1e-9)
        at[i] += offset_mm[f], ++seen_at[i];
  }
  if (2 * seen < n || !(seen_at[0] > 0) || !(seen_at[1] > 0)) return std::nullopt;
  return Summary{sum / seen, at[1] / seen_at[1] - at[0] / seen_at[0]};
}

// The summary of a part in a map; none if it is not visible.
using Curves = std::vector<OffsetCurve>;
std::optional<Summary> summaryOf(const Curves& curves, std::size_t part, double systole) {
  for (const OffsetCurve& curve : curves)
    if (curve.part == part) return summaryOf(curve.offset_mm, systole);
  return std::nullopt;
}

// Mean of the twins, and the variance of the loop's speckle and of this mean together.
struct TwinSpread {
  double mean = 0, variance = 0;
};
TwinSpread spreadOf(const std::vector<Summary>& twins, double Summary::*value) {
  const auto n = static_cast<double>(twins.size());
  TwinSpread out;
  for (const Summary& one : twins) out.mean += one.*value / n;
  for (const Summary& one : twins)
    out.variance += (one.*value - out.mean) * (one.*value - out.mean) / (n - 1) * (1 + 1 / n);
  return out;
}

std::optional<RegionFinding> findingOf(const Curves& loop, const std::vector<Curves>& twins,
                                       std::size_t part, double floor_mm, double systole) {
  const auto curve = std::find_if(loop.begin(), loop.end(),
                                  [&](const OffsetCurve& one) { return one.part == part; });
  if (curve == loop.end()) return std::nullopt;
  const std::optional<Summary> here = summaryOf(curve->offset_mm, systole);
  if (!here) return std::nullopt;
  std::vector<Summary> own;
  for (const Curves& twin : twins) {
    const std::optional<Summary> one = summaryOf(twin, part, systole);
    if (!one) return std::nullopt;
    own.push_back(*one);
  }
  const TwinSpread offset = spreadOf(own, &Summary::offset),
                   motion = spreadOf(own, &Summary::motion);
  RegionFinding out;
  out.pieces = curve->pieces, out.certainty = curve->certainty;
  const double other_mm =
      floor_mm * std::max(1.0, kUsualCertainty / std::max(out.certainty, kTiny));
  out.offset_mm = here->offset - offset.mean;
  out.motion_mm = here->motion - motion.mean;
  out.offset_sd_mm = std::sqrt(offset.variance + other_mm * other_mm);
  out.motion_sd_mm = std::sqrt(motion.variance + other_mm * other_mm);
  out.visible = out.pieces >= kLeastPieces && out.certainty >= kLeastCertainty;
  out.significant = out.visible && out.deviations() > kRegionSds;
  return out;
}

// Pieces beside blood only: other edges have no known sign.
FitMap besideBlood(const FitMap& map) {
  FitMap out;
  for (const std::vector<BoundaryOffset>& frame : map.boundary) {
    out.boundary.emplace_back();
    for (const BoundaryOffset& point : frame)
      if (point.of_blood) out.boundary.back().push_back(point);
  }
  return out;
}

}  // namespace

double RegionFinding::deviations() const {
  return std::max(std::abs(offset_mm) / offset_sd_mm, std::abs(motion_mm) / motion_sd_mm);
}

std::vector<RegionFinding> regionFindings(const FitReport& loop, const std::vector<FitMap>& twins,
                                          const RegionFloor& floor) {
  const std::size_t structures = loop.structures.size();
  const FitMap seen = besideBlood(loop.map);
  std::vector<Curves> own_structures, own_segments;
  for (const FitMap& twin : twins) {
    own_structures.push_back(offsetCurves(besideBlood(twin), structures));
    own_segments.push_back(segmentCurves(twin));
  }
  std::vector<RegionFinding> out;
  const Curves of_structures = offsetCurves(seen, structures), of_segments = segmentCurves(seen);
  for (std::size_t s = 0; s < structures; ++s)
    if (auto finding =
            findingOf(of_structures, own_structures, s, floor.structure_mm, loop.systole)) {
      finding->name = loop.structures[s];
      out.push_back(std::move(*finding));
    }
  for (std::size_t s = 1; s <= kAhaSegments; ++s)
    if (auto finding = findingOf(of_segments, own_segments, s, floor.segment_mm, loop.systole)) {
      finding->segment = s;
      finding->name = kAhaNames[s - 1];
      out.push_back(std::move(*finding));
    }
  return out;
}

nlohmann::ordered_json regionsJson(const std::vector<RegionFinding>& regions) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const RegionFinding& r : regions)
    out.push_back({{r.segment > 0 ? "segment" : "structure", r.name},
                   {"offset_mm", r.offset_mm},
                   {"offset_sd_mm", r.offset_sd_mm},
                   {"motion_mm", r.motion_mm},
                   {"motion_sd_mm", r.motion_sd_mm},
                   {"certainty", r.certainty},
                   {"visible", r.visible},
                   {"significant", r.significant}});
  return out;
}

}  // namespace echocine::fit
