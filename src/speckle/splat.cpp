#include "speckle/splat.h"

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

// A cube's trilinear map as sums over 1, u, v, w, uv, uw, vw, uvw.
struct Trilinear {
  float x[8], y[8], z[8];
  explicit Trilinear(const CubeCorners& c) {
    const auto fill = [&](float* out, auto part) {
      const float p[8] = {part(c[0]), part(c[1]), part(c[2]), part(c[3]),
                          part(c[4]), part(c[5]), part(c[6]), part(c[7])};
      out[0] = p[0];
      out[1] = p[1] - p[0];
      out[2] = p[2] - p[0];
      out[3] = p[4] - p[0];
      out[4] = (p[3] - p[2]) - out[1];
      out[5] = (p[5] - p[4]) - out[1];
      out[6] = (p[6] - p[4]) - out[2];
      out[7] = ((p[7] - p[6]) - (p[5] - p[4])) - out[4];
    };
    fill(x, [](Vec3f p) { return p.x; });
    fill(y, [](Vec3f p) { return p.y; });
    fill(z, [](Vec3f p) { return p.z; });
  }
};

constexpr Ints8 kLaneNumbers{0, 1, 2, 3, 4, 5, 6, 7};

inline bool any(Ints8 mask) {
  Mask4 pairs;
  std::memcpy(&pairs, &mask, sizeof pairs);
  return echocine::any(pairs);
}
inline void store(Ints8 lanes, std::int32_t* to) {
  std::memcpy(to, &lanes, sizeof lanes);
}

// Adds each lane's three numbers to its place, without a branch: half of the lanes are unseen,
// which no processor foresees.
inline void addLanes(Floats8 real, Floats8 imaginary, Floats8 squares, const std::int32_t* places,
                     EchoSum* sums) {
  const Floats8 none{};
  const Floats8 a = __builtin_shufflevector(real, imaginary, 0, 8, 1, 9, 4, 12, 5, 13),
                b = __builtin_shufflevector(real, imaginary, 2, 10, 3, 11, 6, 14, 7, 15),
                c = __builtin_shufflevector(squares, none, 0, 8, 1, 9, 4, 12, 5, 13),
                d = __builtin_shufflevector(squares, none, 2, 10, 3, 11, 6, 14, 7, 15);
  // Lanes 0 and 4, 1 and 5, 2 and 6, 3 and 7.
  const Floats8 pairs[4] = {__builtin_shufflevector(a, c, 0, 1, 8, 9, 4, 5, 12, 13),
                            __builtin_shufflevector(a, c, 2, 3, 10, 11, 6, 7, 14, 15),
                            __builtin_shufflevector(b, d, 0, 1, 8, 9, 4, 5, 12, 13),
                            __builtin_shufflevector(b, d, 2, 3, 10, 11, 6, 7, 14, 15)};
  const auto add = [sums](std::int32_t place, Floats4 numbers) {
    float* to = &sums[place].real;
    Floats4 sum;
    std::memcpy(&sum, to, sizeof sum);
    sum += numbers;
    std::memcpy(to, &sum, sizeof sum);
  };
  for (int i = 0; i < 4; ++i) {
    add(places[i], __builtin_shufflevector(pairs[i], pairs[i], 0, 1, 2, 3));
    add(places[i + 4], __builtin_shufflevector(pairs[i], pairs[i], 4, 5, 6, 7));
  }
}

struct Monomials {
  Floats8 u, v, w, uv, uw, vw, uvw;
  Floats8 sum(const float* c) const {
    return c[0] + u * c[1] + (v * c[2] + w * c[3]) + (uv * c[4] + uw * c[5]) +
           (vw * c[6] + uvw * c[7]);
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

Splatter::Splatter(const Probe& probe, const PointSpread& spread, const BeamView& view)
    : view_(view),
      lines_(probe.lines),
      samples_(probe.samples),
      min_depth_m_(static_cast<float>(probe.min_depth_m)),
      per_spacing_(static_cast<float>(1 / probe.sampleSpacing())),
      turns_per_m_(static_cast<float>(2 / spread.wavelength_m)),
      diffraction_(static_cast<float>(followedWidth(1, spread.aperture_m, spread.wavelength_m))),
      lens_m_(static_cast<float>(spread.aperture_m)),
      per_focus_(static_cast<float>(1 / spread.focus_m)) {}

// Elevation: 2 w_e^2 = d^2 + c^2 with d by diffraction and c by the lens's convergence. With
// q = y^2 / w_e^2 the bell is exp(-4 ln2 q), and the wave's curvature (c / d) 8 ln2 q / 4 pi turns.
void Splatter::add(const CubeCorners& corners, const Scatterers& scatterers,
                   const ScattererBatch& batch, const GaussianMix& mix, EchoSums& sums) const {
  constexpr float kFourLn2 = 2.7725887f, kCurvature = 0.44127125f;  // 8 ln2 / (4 pi)
  const Trilinear map(corners);
  std::int32_t places[kFloatLanes];
  const float* strength = scatterers.strength(batch);
  const float *us = scatterers.u(batch), *vs = scatterers.v(batch), *ws = scatterers.w(batch);
  for (std::uint32_t j = 0; j < batch.count; j += kFloatLanes) {
    Monomials m{lanesAt(us + j), lanesAt(vs + j), lanesAt(ws + j), {}, {}, {}, {}};
    m.uv = m.u * m.v;
    m.uw = m.u * m.w;
    m.vw = m.v * m.w;
    m.uvw = m.uv * m.w;
    const Floats8 x = m.sum(map.x), y = m.sum(map.y), z = m.sum(map.z);
    const BeamView::Place8 at = view_.placeOf(x, z);
    const Floats8 held = at.path_m > 1e-4f ? at.path_m : 1e-4f;
    const Floats8 d = diffraction_ * held, c = lens_m_ * (1 - held * per_focus_);
    const Floats8 q = 2 * (y * y) / (d * d + c * c);
    const Floats8 sample = (at.path_m - min_depth_m_) * per_spacing_, line = at.line + 0.5f;
    const Ints8 seen = (q <= static_cast<float>(kElevationCut * kElevationCut)) & (z > 0) &
                       (sample >= 0) & (sample < static_cast<float>(samples_)) & (line >= 0) &
                       (line < static_cast<float>(lines_));
    if (!any(seen)) continue;
    const Floats8 e = fallingExp(kFourLn2 * q);
    // exp(-2 pi j turns); folded to a quarter turn either side of 0.
    const Floats8 turns = at.path_m * turns_per_m_ + (c / d) * (kCurvature * q);
    const Floats8 f = turns - nearest(turns), part = f < 0 ? -f : f;
    const Floats8 half = f < 0 ? Floats8{} - 0.5f : Floats8{} + 0.5f;
    const Floats8 sine = sineOfQuarters(4 * (part > 0.25f ? half - f : f));
    const Floats8 cosine = sineOfQuarters(1 - 4 * part);
    const Floats8 cr = mix.a * lanesAt(mix.real_a + j) + mix.b * lanesAt(mix.real_b + j),
                  ci = mix.a * lanesAt(mix.imaginary_a + j) + mix.b * lanesAt(mix.imaginary_b + j);
    // What the ratio is normalised by knows nothing of the tissue's own strength.
    const Floats8 held_e = strength ? e * lanesAt(strength + j) : e;
    const Floats8 real = held_e * (cr * cosine + ci * sine),
                  imaginary = held_e * (ci * cosine - cr * sine), squares = e * e;
    const Ints8 at_line = __builtin_convertvector(line, Ints8) & seen,
                at_sample = __builtin_convertvector(sample, Ints8) & seen;
    const Ints8 unseen = kLaneNumbers + lines_ * samples_;  // a place that nobody reads
    store(seen ? at_line * samples_ + at_sample : unseen, places);
    addLanes(real, imaginary, squares, places, sums.sums.data());
  }
}

}  // namespace echocine
