#include "trace/strand_echoes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "core/units.h"
#include "scene/elevation_slices.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

constexpr double kDeviations = 4;  // beyond these the beam is taken as 0

// The segment of a line at a path length; null behind the end of the ray.
const MediumSegment* segmentAt(const LineTrace& line, double path_m) {
  const MediumSegment* found = nullptr;
  for (const MediumSegment& segment : line.segments) {
    if (segment.begin_path_m > path_m) break;
    found = &segment;
  }
  if (!found) return nullptr;
  const double end_path_m =
      found->begin_path_m + found->path_per_depth * (found->end_depth_m - found->begin_depth_m);
  return path_m < end_path_m ? found : nullptr;
}

class StrandAdder {
 public:
  StrandAdder(double diameter_m, const Probe& probe, const TraceSettings& settings,
              const IntensityTerms& terms, PolarFrame& frame)
      : section_m2_(std::numbers::pi / 4 * diameter_m * diameter_m),
        probe_(probe),
        settings_(settings),
        terms_(terms),
        frame_(frame),
        sampling_(samplingOf(probe, settings)),
        scan_(probe),
        bell_(probe) {
    for (int line = 0; line < probe.lines; ++line)
      directions_.push_back(lineGeometry(probe, line).direction);
  }

  void add(const Strand& strand) {
    for (std::size_t i = 0; i + 1 < strand.points.size(); ++i) {
      const Vec3d from = toDouble(strand.points[i]), to = toDouble(strand.points[i + 1]);
      const double length_m = length(to - from);
      if (isBeyond(from, to, length_m)) continue;
      const int pieces = std::max(1, static_cast<int>(std::ceil(length_m / sampling_.spacing_m)));
      for (int k = 0; k < pieces; ++k)
        addPiece(from + ((k + 0.5) / pieces) * (to - from), (1.0 / pieces) * (to - from), strand);
    }
  }

 private:
  // True only where the beam reaches no piece between the two points. Between two path lengths, the
  // beam's deviation is largest at one of them.
  bool isBeyond(Vec3d from, Vec3d to, double length_m) const {
    if (from.y * to.y <= 0) return false;
    constexpr double kSlack = 1 + 1e-9;  // for rounding
    const double one_m = scan_.pathOf({from.x, 0, from.z}), other_m = scan_.pathOf({to.x, 0, to.z});
    const double widest_m = std::max(bell_.deviation(std::min(one_m, other_m) - length_m),
                                     bell_.deviation(std::max(one_m, other_m)));
    return std::min(std::abs(from.y), std::abs(to.y)) > kSlack * kDeviations * widest_m;
  }

  void addPiece(Vec3d at, Vec3d piece, const Strand& strand) {
    const std::optional<ScanGeometry::BeamPosition> place = scan_.beamPosition(at.x, at.z);
    if (!place) return;
    const double deviation_m = bell_.deviation(place->path_m), u = at.y / deviation_m;
    if (std::abs(u) > kDeviations) return;
    const double per_m = std::exp(-0.5 * u * u) / (std::sqrt(2 * std::numbers::pi) * deviation_m);
    const double cell_m2 = lineSpacing(probe_, place->path_m) * sampling_.spacing_m;
    const int line = static_cast<int>(place->line);
    const double piece_m = length(piece);
    if (!(piece_m > 0)) return;
    const double cosine = dot(piece, directions_[static_cast<std::size_t>(line)]) / piece_m;
    const double share = intensityFromDecibels(-kStrandAnisotropy_db * cosine * cosine) * per_m *
                         section_m2_ * piece_m / cell_m2;
    const double beside = place->line - line;
    addToLine(line, place->path_m, (1 - beside) * share, strand);
    const int next = scan_.fullTurn() ? (line + 1) % probe_.lines : line + 1;
    if (next < probe_.lines) addToLine(next, place->path_m, beside * share, strand);
  }

  void addToLine(int line, double path_m, double share, const Strand& strand) {
    if (!(share > 0)) return;
    const MediumSegment* around = segmentAt(frame_.traces[static_cast<std::size_t>(line)], path_m);
    if (!around) return;
    const double own =
        strand.backscatter * settings_.media[index(strand.medium)].backscatter_per_m_sr;
    const double other = settings_.media[index(around->medium)].backscatter_per_m_sr;
    if (own <= other) return;
    // eta_b V times the losses before: those of the medium around, if it scatters.
    const double strength =
        other > 0 ? around->strength_m2_sr / other * (own - other) : own * settings_.unit_volume_m3;
    const double depth_m =
        around->begin_depth_m + (path_m - around->begin_path_m) / around->path_per_depth;
    double value = share * strength;
    if (terms_.attenuation)
      value *= std::exp(
          -(around->begin_exponent + around->exponent_per_m * (depth_m - around->begin_depth_m)));
    const double spread_m = terms_.spread_undone_at_m > 0
                                ? terms_.spread_undone_at_m
                                : std::max(path_m, sampling_.spread_from_m);
    value /= spread_m * spread_m;
    const double place = (depth_m - sampling_.min_depth_m) / sampling_.spacing_m - 0.5;
    const double first = std::floor(place), behind = place - first;
    addToSample(line, static_cast<int>(first), (1 - behind) * value);
    addToSample(line, static_cast<int>(first) + 1, behind * value);
  }

  void addToSample(int line, int sample, double value) {
    if (sample < 0 || sample >= sampling_.samples) return;
    frame_.intensities.values[static_cast<std::size_t>(line * sampling_.samples + sample)] +=
        static_cast<float>(value);
  }

  double section_m2_;
  const Probe& probe_;
  const TraceSettings& settings_;
  const IntensityTerms& terms_;
  PolarFrame& frame_;
  Sampling sampling_;
  ScanGeometry scan_;
  ElevationBell bell_;
  std::vector<Vec3d> directions_;  // by line
};

}  // namespace

void addStrands(std::span<const Strand> strands, double diameter_m, const Probe& probe,
                const TraceSettings& settings, const IntensityTerms& terms, PolarFrame& frame) {
  StrandAdder adder(diameter_m, probe, settings, terms, frame);
  for (const Strand& strand : strands) adder.add(strand);
}

}  // namespace echocine
