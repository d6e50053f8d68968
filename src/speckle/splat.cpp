#include "speckle/splat.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "core/hash_random.h"
#include "scene/beam_profile.h"
#include "speckle/across_range.h"

namespace echocine {

namespace {

// A trilinear function in a cube, as a sum over 1, u, v, uv, w, uw, vw, uvw of stored
// positions.
struct Trilinear {
  Floats8 c[8];  // each in all lanes
  // From the values at the corners: along each axis in turn the upper end less the lower.
  explicit Trilinear(Floats8 at) {
    const Floats8 none{};
    Floats8 low = __builtin_shufflevector(at, none, 8, 0, 8, 2, 8, 4, 8, 6);
    at -= low;
    low = __builtin_shufflevector(at, none, 8, 8, 0, 1, 8, 8, 4, 5);
    at -= low;
    low = __builtin_shufflevector(at, none, 8, 8, 8, 8, 0, 1, 2, 3);
    at -= low;
    constexpr float k1 = 1.0f / kCubeEdge, k2 = k1 * k1;
    at *= Floats8{1, k1, k1, k2, k1, k2, k2, k2 * k1};
    for (int i = 0; i < 8; ++i)
      c[i] = Floats8{at[i], at[i], at[i], at[i], at[i], at[i], at[i], at[i]};
  }
  Floats8 at(Floats8 u, Floats8 v, Floats8 w) const {
    return ((c[0] + u * c[1]) + v * (c[2] + u * c[3])) +
           w * ((c[4] + u * c[5]) + v * (c[6] + u * c[7]));
  }
};

Floats8 floatsAt(const std::uint16_t* from) {
  Shorts8 lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return __builtin_convertvector(__builtin_convertvector(lanes, Ints8), Floats8);
}

constexpr float kLeastDepth_m = 1e-4f;       // of a scatterer, for the lens's phase
constexpr std::ptrdiff_t kPlacesAhead = 16;  // eights that memory is asked for. Our choice, by time

}  // namespace

GaussianMix mixAt(const GaussianTable& table, std::uint64_t pattern, double time_s, double tau_s,
                  bool staggered) {
  if (!(tau_s > 0)) {
    const std::uint64_t start = mixBits(pattern);
    return {table.real(start), table.imaginary(start), table.real(start), table.imaginary(start)};
  }
  const double stagger = staggered ? uniformFromHash(hashOf(pattern, 0x7e)) : 0;
  const double at = time_s / tau_s + stagger;
  const double floor = std::floor(at);
  // From 2^52 on a double has no fraction: each instant then has a draw of its own, by its bits.
  const bool whole = !(std::abs(at) < 0x1p52);
  const auto m = whole ? std::bit_cast<std::int64_t>(at) : static_cast<std::int64_t>(floor);
  const double f = whole ? 0 : at - floor;
  const auto startOf = [&](std::int64_t number) {
    return staggered || number != 0 ? hashOf(pattern, number) : mixBits(pattern);
  };
  const std::uint64_t one = startOf(m), two = startOf(m + 1);
  return {table.real(one),
          table.imaginary(one),
          table.real(two),
          table.imaginary(two),
          static_cast<float>(std::cos(std::numbers::pi / 2 * f)),
          static_cast<float>(std::sin(std::numbers::pi / 2 * f))};
}

Splatter::Splatter(const Probe& probe, const PointSpread& spread)
    : samples_(static_cast<float>(probe.samples)),
      turns_per_sample_(static_cast<float>(2 * probe.sampleSpacing() / spread.wavelength_m)),
      turns_before_(
          static_cast<float>(std::fmod(2 * probe.min_depth_m / spread.wavelength_m, 1.0))),
      min_depth_m_(static_cast<float>(probe.min_depth_m)),
      spacing_m_(static_cast<float>(probe.sampleSpacing())) {
  constexpr double kTurns = 0.44127125 * kElevationCut * kElevationCut;  // 8 ln2 / (4 pi) q
  const double lens =
      kTurns * spread.aperture_m / followedWidth(1, spread.aperture_m, spread.wavelength_m);
  bend_ = static_cast<float>(lens);
  bend_at_focus_ = static_cast<float>(lens / spread.focus_m);
}

// With d the part of w_e by diffraction and c by the lens's convergence (2 w_e^2 = d^2 + c^2) and
// q = y^2 / w_e^2, the wave's curvature adds (c / d) 8 ln2 q / 4 pi turns. c / d as a line between
// the cube's ends, which is off by under a per cent over its depth.
inline Splatter::Bend Splatter::bendOf(Floats8 sample) const {
  const auto pairs = [](Floats8 a) {
    return __builtin_shufflevector(a, a, 4, 5, 6, 7, 0, 1, 2, 3);
  };
  const auto next = [](Floats8 a) { return __builtin_shufflevector(a, a, 2, 3, 0, 1, 6, 7, 4, 5); };
  Floats8 low = sample, high = sample;
  low = smaller(low, pairs(low));
  high = larger(high, pairs(high));
  low = smaller(low, next(low));
  high = larger(high, next(high));
  const float first = std::min(low[0], low[1]), last = std::max(high[0], high[1]);
  const auto at = [&](float k) {
    return bend_ / std::max(min_depth_m_ + k * spacing_m_, kLeastDepth_m) - bend_at_focus_;
  };
  const float at_first = at(first);
  const float slope = last > first ? (at(last) - at_first) / (last - first) : 0;
  return {at_first - slope * first, slope};
}

inline void Splatter::addLanes(const BeamCube& at, Floats8 lens_turns, const GaussianMix& mix,
                               std::uint32_t j, std::uint32_t count, SplatLists& splats) const {
  constexpr Ints8 kLane{0, 1, 2, 3, 4, 5, 6, 7};
  const Floats8 q = at.across * at.across;
  const Floats8 turns = (turns_before_ + at.sample * turns_per_sample_) + q * lens_turns;
  splats.add({at.line, at.sample, q, turns, mix.real(j), mix.imaginary(j)},
             (q <= 1) & (at.sample >= 0) & (at.sample < samples_) &
                 (kLane < static_cast<std::int32_t>(count - j)));
}

// Places ascend in v.
void Splatter::add(const BeamCube& cube, const Scatterers& scatterers, const ScattererBatch& batch,
                   const GaussianMix& mix, SplatLists& splats) const {
  const Trilinear lines(cube.line), samples(cube.sample), acrosses(cube.across);
  const AcrossRange range(cube.across);
  const Bend bend = bendOf(cube.sample);
  const EightPlaces* places = scatterers.places(batch);
  const std::uint32_t end = scatterers.endOf(batch, range.last);
  for (std::uint32_t j = scatterers.firstOf(batch, range.first); j < end; j += kFloatLanes) {
    const std::uint32_t n = j / kFloatLanes;
    const Floats8 u = floatsAt(places[n].u), v = floatsAt(places[n].v), w = floatsAt(places[n].w);
    __builtin_prefetch(places + n + kPlacesAhead);
    const Floats8 sample = samples.at(u, v, w);
    addLanes({lines.at(u, v, w), sample, acrosses.at(u, v, w)}, bend.at(sample), mix, j,
             batch.count, splats);
  }
}

void Splatter::addPlaces(const BeamCube& at, const GaussianMix& mix, std::uint32_t j,
                         SplatLists& splats) const {
  // They may lie anywhere on a sheet, so each takes its own depth.
  const Floats8 depth_m = larger(min_depth_m_ + at.sample * spacing_m_, Floats8{} + kLeastDepth_m);
  addLanes(at, bend_ / depth_m - bend_at_focus_, mix, j, j + kFloatLanes, splats);
}

}  // namespace echocine
