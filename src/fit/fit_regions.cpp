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
TwinSpread spreadOf(const std::vector<double>& twins) {
  const auto n = static_cast<double>(twins.size());
  TwinSpread out;
  for (const double one : twins) out.mean += one / n;
  for (const double one : twins)
    out.variance += (one - out.mean) * (one - out.mean) / (n - 1) * (1 + 1 / n);
  return out;
}

// A part of the boundaries, and what the loop and the twins show of it.
struct Part {
  RegionFinding finding;
  double here = 0;          // offset in the loop, mm
  std::vector<double> own;  // and in each twin
  double faint = 1;         // factor of the standard deviations
};

std::optional<Part> partOf(const Curves& loop, const std::vector<Curves>& twins, std::size_t part,
                           double floor_mm, double systole) {
  const auto curve = std::find_if(loop.begin(), loop.end(),
                                  [&](const OffsetCurve& one) { return one.part == part; });
  if (curve == loop.end()) return std::nullopt;
  const std::optional<Summary> here = summaryOf(curve->offset_mm, systole);
  if (!here) return std::nullopt;
  Part out;
  std::vector<double> motions;
  for (const Curves& twin : twins) {
    const std::optional<Summary> one = summaryOf(twin, part, systole);
    if (!one) return std::nullopt;
    out.own.push_back(one->offset);
    motions.push_back(one->motion);
  }
  out.here = here->offset;
  RegionFinding& f = out.finding;
  f.pieces = curve->pieces, f.certainty = curve->certainty;
  out.faint = std::max(1.0, kUsualCertainty / std::max(f.certainty, kTiny));
  const TwinSpread offset = spreadOf(out.own), motion = spreadOf(motions);
  f.offset_mm = here->offset - offset.mean;
  f.motion_mm = here->motion - motion.mean;
  f.offset_sd_mm = std::hypot(std::sqrt(offset.variance), floor_mm * out.faint);
  f.motion_sd_mm = std::hypot(std::sqrt(motion.variance), floor_mm * out.faint);
  f.visible = f.pieces >= kLeastPieces && f.certainty >= kLeastCertainty;
  return out;
}

// The offset of a segment minus the mean of its neighbours: of two or more, all visible.
void addLocal(const std::vector<Part>& segments, double floor_mm, Part& part) {
  std::vector<const Part*> beside;
  for (const Part& other : segments)
    if (other.finding.visible && areAdjacent(other.finding.segment, part.finding.segment))
      beside.push_back(&other);
  if (beside.size() < 2) return;
  const double share = 1 / static_cast<double>(beside.size());
  double here = part.here, square = part.faint * part.faint;
  std::vector<double> own = part.own;
  for (const Part* other : beside) {
    here -= share * other->here;
    square += share * share * other->faint * other->faint;
    for (std::size_t t = 0; t < own.size(); ++t) own[t] -= share * other->own[t];
  }
  const TwinSpread spread = spreadOf(own);
  part.finding.local_mm = here - spread.mean;
  part.finding.local_sd_mm =
      std::sqrt(spread.variance + floor_mm * floor_mm * square / (1 + share));
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
  return std::max({std::abs(offset_mm) / offset_sd_mm, std::abs(motion_mm) / motion_sd_mm,
                   local_mm ? std::abs(*local_mm) / local_sd_mm : 0});
}

RegionFloor floorWithOwnLook(double agreement) {
  const double plain = std::clamp((1 - agreement) / (1 - kPlainAgreement), 0.0, 1.0);
  const auto between = [&](double RegionFloor::*one) {
    return std::lerp(kFittedWithOwnLook.*one, kFittedDials.*one, plain);
  };
  return {between(&RegionFloor::segment_mm), between(&RegionFloor::structure_mm),
          between(&RegionFloor::local_mm)};
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
  const Curves of_structures = offsetCurves(seen, structures), of_segments = segmentCurves(seen);
  std::vector<Part> parts, segments;
  for (std::size_t s = 0; s < structures; ++s)
    if (auto part = partOf(of_structures, own_structures, s, floor.structure_mm, loop.systole)) {
      part->finding.name = loop.structures[s];
      parts.push_back(std::move(*part));
    }
  for (std::size_t s = 1; s <= kAhaSegments; ++s)
    if (auto part = partOf(of_segments, own_segments, s, floor.segment_mm, loop.systole)) {
      part->finding.segment = s;
      part->finding.name = kAhaNames[s - 1];
      segments.push_back(std::move(*part));
    }
  for (Part& part : segments) addLocal(segments, floor.local_mm, part);
  parts.insert(parts.end(), segments.begin(), segments.end());
  std::vector<RegionFinding> out;
  for (Part& part : parts) {
    part.finding.significant = part.finding.visible && part.finding.deviations() > kRegionSds;
    out.push_back(std::move(part.finding));
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
                   {"local_mm", r.local_mm ? nlohmann::ordered_json(*r.local_mm) : nullptr},
                   {"local_sd_mm", r.local_mm ? nlohmann::ordered_json(r.local_sd_mm) : nullptr},
                   {"certainty", r.certainty},
                   {"visible", r.visible},
                   {"significant", r.significant}});
  return out;
}

}  // namespace echocine::fit
