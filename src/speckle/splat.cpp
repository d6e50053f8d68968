#include "speckle/splat.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/hash_random.h"
#include "scene/beam_profile.h"

namespace echocine {

namespace {

// To the nearest whole number, of magnitudes below 2^22.
inline Floats8 nearest(Floats8 a) {
  constexpr float kMagic = 12582912.0f;  // 1.5 2^23
  return (a + kMagic) - kMagic;
}

// sin(pi x / 2) for |x| <= 1, to 1e-6 (Hastings, "Approximations for Digital Computers", 1955).
inline Floats8 sineOfQuarters(Floats8 x) {
  const Floats8 x2 = x * x;
  return x * (1.570794852f + x2 * (-0.645920978f + x2 * (0.079487663f + x2 * -0.004362476f)));
}

// exp(-u) for 0 <= u <= 2.3, to 2e-5: the eighth power of a short series.
inline Floats8 fallingExp(Floats8 u) {
  const Floats8 v = u * -0.125f;
  Floats8 e = 1 + v * (1 + v * (0.5f + v * (1.0f / 6 + v * (1.0f / 24))));
  e *= e;
  e *= e;
  return e * e;
}

// What is trilinear in a cube, as sums over 1, u, v, uv, w, uw, vw, uvw.
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
    for (int i = 0; i < 8; ++i)
      c[i] = Floats8{at[i], at[i], at[i], at[i], at[i], at[i], at[i], at[i]};
  }
};

inline bool any(Ints8 mask) {
  Mask4 pairs;
  std::memcpy(&pairs, &mask, sizeof pairs);
  return echocine::any(pairs);
}
inline void store(Ints8 lanes, std::int32_t* to) {
  std::memcpy(to, &lanes, sizeof lanes);
}

// By lane: its four numbers side by side.
struct LaneSplats {
  Splat lane[kFloatLanes];
  LaneSplats(Floats8 real, Floats8 imaginary, Floats8 squares, Ints8 samples) {
    const Floats8 at = reinterpret_cast<Floats8>(samples);
    const Floats8 a = __builtin_shufflevector(real, imaginary, 0, 8, 1, 9, 4, 12, 5, 13),
                  b = __builtin_shufflevector(real, imaginary, 2, 10, 3, 11, 6, 14, 7, 15),
                  c = __builtin_shufflevector(squares, at, 0, 8, 1, 9, 4, 12, 5, 13),
                  d = __builtin_shufflevector(squares, at, 2, 10, 3, 11, 6, 14, 7, 15);
    // Lanes 0 and 4, 1 and 5, 2 and 6, 3 and 7.
    const Floats8 pairs[4] = {__builtin_shufflevector(a, c, 0, 1, 8, 9, 4, 5, 12, 13),
                              __builtin_shufflevector(a, c, 2, 3, 10, 11, 6, 7, 14, 15),
                              __builtin_shufflevector(b, d, 0, 1, 8, 9, 4, 5, 12, 13),
                              __builtin_shufflevector(b, d, 2, 3, 10, 11, 6, 7, 14, 15)};
    for (int i = 0; i < 4; ++i) {
      const Floats4 low = __builtin_shufflevector(pairs[i], pairs[i], 0, 1, 2, 3),
                    high = __builtin_shufflevector(pairs[i], pairs[i], 4, 5, 6, 7);
      std::memcpy(&lane[i], &low, sizeof low);
      std::memcpy(&lane[i + 4], &high, sizeof high);
    }
  }
};

struct Monomials {
  Floats8 u, v, w, uv, uw, vw, uvw;
  Monomials(Floats8 u1, Floats8 v1, Floats8 w1)
      : u(u1), v(v1), w(w1), uv(u * v), uw(u * w), vw(v * w), uvw(uv * w) {}
  Floats8 sum(const Trilinear& t) const {
    const Floats8* c = t.c;
    return (c[0] + u * c[1]) + (v * c[2] + uv * c[3]) +
           ((w * c[4] + uw * c[5]) + (vw * c[6] + uvw * c[7]));
  }
};

}  // namespace

GaussianMix mixAt(const GaussianTable& table, std::uint64_t pattern, double time_s, double tau_s) {
  if (!(tau_s > 0)) {
    const std::uint64_t start = mixBits(pattern);
    return {table.real(start), table.imaginary(start), table.real(start), table.imaginary(start)};
  }
  const double at = time_s / tau_s + uniformFromHash(hashOf(pattern, 0x7e));
  const double m = std::floor(at), f = at - m;
  const std::uint64_t one = hashOf(pattern, static_cast<std::int64_t>(m)),
                      two = hashOf(pattern, static_cast<std::int64_t>(m) + 1);
  return {table.real(one),
          table.imaginary(one),
          table.real(two),
          table.imaginary(two),
          static_cast<float>(std::cos(std::numbers::pi / 2 * f)),
          static_cast<float>(std::sin(std::numbers::pi / 2 * f))};
}

Splatter::Splatter(const Probe& probe, const PointSpread& spread)
    : samples_(probe.samples),
      turns_per_sample_(static_cast<float>(2 * probe.sampleSpacing() / spread.wavelength_m)),
      turns_before_(
          static_cast<float>(std::fmod(2 * probe.min_depth_m / spread.wavelength_m, 1.0))),
      min_depth_m_(probe.min_depth_m),
      spacing_m_(probe.sampleSpacing()),
      lens_(spread.aperture_m / followedWidth(1, spread.aperture_m, spread.wavelength_m)),
      focus_m_(spread.focus_m) {}

// With d the part of w_e by diffraction and c by the lens's convergence (2 w_e^2 = d^2 + c^2) and
// q = y^2 / w_e^2, the wave's curvature adds (c / d) 8 ln2 q / 4 pi turns. c / d as a line between
// the cube's ends, which is off by under a per cent over its depth.
Splatter::Bend Splatter::bendOf(Floats8 sample) const {
  constexpr double kTurns = 0.44127125 * kElevationCut * kElevationCut;  // 8 ln2 / (4 pi) q
  float low = sample[0], high = sample[0];
  for (std::size_t i = 1; i < kFloatLanes; ++i) {
    low = std::min(low, sample[i]);
    high = std::max(high, sample[i]);
  }
  const auto at = [&](float k) {
    const double path_m = std::max(min_depth_m_ + static_cast<double>(k) * spacing_m_, 1e-4);
    return kTurns * lens_ * (1 / path_m - 1 / focus_m_);
  };
  const double first = at(low), last = at(high);
  const double slope = high > low ? (last - first) / static_cast<double>(high - low) : 0;
  return {static_cast<float>(first - slope * static_cast<double>(low)), static_cast<float>(slope)};
}

// Elevation: with s the place across in parts of the cut the bell is exp(-4 ln2 cut^2 s^2).
inline void Splatter::addLanes(const BeamCube& at, const Bend& bend, const GaussianMix& mix,
                               std::uint32_t j, SplatLists& splats) const {
  constexpr float kBell = static_cast<float>(2.7725887222397811 * kElevationCut * kElevationCut);
  const Floats8 q = at.across * at.across;
  const Ints8 seen = (q <= 1) & (at.sample >= 0) & (at.sample < static_cast<float>(samples_)) &
                     splats.keeps(at.line);
  const Floats8 e = fallingExp(kBell * q);
  // exp(-2 pi j turns); folded to a quarter turn either side of 0.
  const Floats8 turns =
      (turns_before_ + at.sample * turns_per_sample_) + q * (bend.first + at.sample * bend.slope);
  const Floats8 f = turns - nearest(turns), part = f < 0 ? -f : f;
  const Floats8 half = f < 0 ? Floats8{} - 0.5f : Floats8{} + 0.5f;
  const Floats8 sine = sineOfQuarters(4 * (part > 0.25f ? half - f : f));
  const Floats8 cosine = sineOfQuarters(1 - 4 * part);
  const Floats8 cr = mix.real(j), ci = mix.imaginary(j);
  const Floats8 real = e * (cr * cosine + ci * sine), imaginary = e * (ci * cosine - cr * sine),
                squares = e * e;
  splats.add(LaneSplats(real, imaginary, squares, __builtin_convertvector(at.sample, Ints8)).lane,
             __builtin_convertvector(at.line, Ints8) & seen, seen);
}

void Splatter::add(const BeamCube& cube, const Scatterers& scatterers, const ScattererBatch& batch,
                   const GaussianMix& mix, SplatLists& splats) const {
  const Trilinear lines(cube.line), samples(cube.sample), acrosses(cube.across);
  const Bend bend = bendOf(cube.sample);
  const float *us = scatterers.u(batch), *vs = scatterers.v(batch), *ws = scatterers.w(batch);
  for (std::uint32_t j = 0; j < batch.count; j += kFloatLanes) {
    const Monomials m(lanesAt(us + j), lanesAt(vs + j), lanesAt(ws + j));
    const Floats8 across = m.sum(acrosses);
    if (any(across * across <= 1))
      addLanes({m.sum(lines), m.sum(samples), across}, bend, mix, j, splats);
  }
}

void Splatter::addPlaces(const BeamCube& at, const GaussianMix& mix, std::uint32_t j,
                         SplatLists& splats) const {
  addLanes(at, bendOf(at.sample), mix, j, splats);
}

// Without a branch: a third of the lanes are unseen, which no processor foresees. What they write
// is written over. Memory is asked for some splats ahead. Our choice, by time.
void SplatLists::add(const Splat* splats, Ints8 lines, Ints8 seen) {
  constexpr std::ptrdiff_t kAhead = 12;
  std::int32_t at[kFloatLanes], taken[kFloatLanes];
  store(lines, at);
  store(seen, taken);
  for (std::size_t i = 0; i < kFloatLanes; ++i) {
    List& list = lists_[static_cast<std::size_t>(at[i])];
    if (list.next == list.end) grow(list);
    *list.next = splats[i];
    __builtin_prefetch(list.next + kAhead, 1);
    list.next -= taken[i];
  }
}

void SplatLists::grow(List& list) {
  const std::size_t count = list.memory.size();
  list.memory.resize(std::max<std::size_t>(2 * count, 64));
  list.next = list.memory.data() + count;
  list.end = list.memory.data() + list.memory.size();
}

}  // namespace echocine
