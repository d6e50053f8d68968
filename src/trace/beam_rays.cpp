#include "trace/beam_rays.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "core/check.h"
#include "core/hash_random.h"
#include "scene/beam_profile.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

constexpr std::uint64_t kPurpose = 0xbea3;  // tells these random numbers from others of the seed

constexpr std::uint32_t reversed(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0xff00ff00u) >> 8) | ((x & 0x00ff00ffu) << 8);
  x = ((x & 0xf0f0f0f0u) >> 4) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x & 0xccccccccu) >> 2) | ((x & 0x33333333u) << 2);
  return ((x & 0xaaaaaaaau) >> 1) | ((x & 0x55555555u) << 1);
}

// Owen's nested uniform scrambling as a hash: each bit flips by what the bits above it are
// (B. Burley, "Practical hash-based Owen scrambling", J. Computer Graphics Techniques 9(4), 2020).
constexpr std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
  x = reversed(x) + seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return reversed(x);
}

// The second dimension of Sobol's sequence (primitive polynomial x + 1); the first is reversed().
constexpr std::uint32_t secondSobol(std::uint32_t i) {
  std::uint32_t bits = 0;
  for (std::uint32_t v = 1u << 31; i != 0; i >>= 1, v ^= v >> 1)
    if (i & 1) bits ^= v;
  return bits;
}

constexpr double unitFromBits(std::uint32_t bits) {
  return (bits + 0.5) * 0x1p-32;
}

constexpr int kWide = 8;
using Block = float __attribute__((vector_size(kWide * sizeof(float))));
using IntBlock = std::int32_t __attribute__((vector_size(kWide * sizeof(std::int32_t))));

// 2^-t for 0 <= t < 126: the nearest whole number goes into the exponent's bits, the rest, within
// 1/2, through Taylor's series to the sixth power, whose remainder is under 1.2e-7.
Block powerOfHalf(Block t) {
  constexpr float c = -static_cast<float>(std::numbers::ln2);
  const IntBlock whole = __builtin_convertvector(t + 0.5f, IntBlock);
  const Block x = (t - __builtin_convertvector(whole, Block)) * c;
  const Block x2 = x * x;
  const Block low = 1.0f + x + x2 * (1.0f / 2 + x * (1.0f / 6));
  const Block high = 1.0f / 24 + x * (1.0f / 120) + x2 * (1.0f / 720);
  const IntBlock bits = (127 - whole) << 23;
  Block scale;
  std::memcpy(&scale, &bits, sizeof scale);
  return (low + x2 * x2 * high) * scale;
}

}  // namespace

// Hastings' approximation (Abramowitz and Stegun, 26.2.23, to 4.5e-4) and a step of Halley's
// method. Worked in the lower half, where the complement loses no digits.
double normalQuantile(double u) {
  const double p = std::min(u, 1 - u);
  const double t = std::sqrt(-2 * std::log(p));
  double x = (2.515517 + t * (0.802853 + t * 0.010328)) /
                 (1 + t * (1.432788 + t * (0.189269 + t * 0.001308))) -
             t;
  const double error = 0.5 * std::erfc(-x / std::numbers::sqrt2) - p;
  const double step = error * std::sqrt(2 * std::numbers::pi) * std::exp(x * x / 2);
  x -= step / (1 + x * step / 2);
  return u < 0.5 ? x : -x;
}

std::array<double, 3> beamPoint(std::uint64_t pattern, int i, int n) {
  const auto index = static_cast<std::uint32_t>(i);
  const auto seed = [&](std::uint64_t dimension) {
    return static_cast<std::uint32_t>(hashOf(pattern, dimension) >> 32);
  };
  return {(i + uniformFromHash(hashOf(pattern, std::uint64_t{0}, index))) / n,
          unitFromBits(scrambled(reversed(index), seed(1))),
          unitFromBits(scrambled(secondSobol(index), seed(2)))};
}

namespace {

// q at the ends of n strata of equal probability. The outermost end as far beyond their means,
// n phi(q) from the centre, as these are from their inner ends.
std::vector<double> strataEnds(int n) {
  if (n == 1) return {0, 0};
  std::vector<double> ends(static_cast<std::size_t>(n) + 1);
  for (int i = 1; i < n; ++i)
    ends[static_cast<std::size_t>(i)] = normalQuantile(static_cast<double>(i) / n);
  const double inner = ends[static_cast<std::size_t>(n) - 1];
  const double mean = n * std::exp(-inner * inner / 2) / std::sqrt(2 * std::numbers::pi);
  ends.back() = 2 * mean - inner;
  ends.front() = -ends.back();
  return ends;
}

}  // namespace

BeamSpread beamSpread(const EffectPlan& plan, int seed) {
  return {plan.rays_per_beam, plan.lateral_rays, plan.elevation, seed};
}

BeamRays::BeamRays(const Probe& probe, const BeamSpread& spread) : spread_(spread) {
  CHECK_LE(1, spread.rays);
  const ScanGeometry geometry(probe);
  const double wavelength_m = geometry.wavelength();
  // Widths of diffraction at 1 m are widths per metre.
  lateral_slope_ = followedWidth(1, probe.aperture_m, wavelength_m) / kWidthPerDeviation;
  const double one_way = 1 / (kWidthPerDeviation * std::numbers::sqrt2);  // of the lens, of two
  lens_m_ = probe.elevation_aperture_m * one_way;
  tilt_ = followedWidth(1, probe.elevation_aperture_m, wavelength_m) * one_way;
  focus_m_ = probe.elevation_focus_m;
  for (int k = 0; k < probe.samples; ++k) {
    const double z = geometry.sampleDepth(k);
    const double ratio = followedWidth(z, probe.aperture_m, wavelength_m) /
                         focusedWidth(z, probe.aperture_m, probe.focus_m, wavelength_m);
    transmit_.push_back(static_cast<float>(ratio * ratio));
  }
  transmit_.resize(transmit_.size() + kWide);  // read by whole blocks
  if (spread.lateral) strata_ = strataEnds(spread.rays);
}

std::uint64_t BeamRays::pattern(int frame, int line) const {
  return hashOf(spread_.seed, kPurpose, frame, line);
}

BeamRay BeamRays::ray(const LineGeometry& line, std::uint64_t pattern, int i) const {
  // Dimensions in the order of what is spread: the first is the best stratified.
  const std::array<double, 3> point = beamPoint(pattern, i, spread_.rays);
  std::size_t dimension = 0;
  const double q = spread_.lateral ? normalQuantile(point[dimension++]) : 0;
  const double p = spread_.elevation ? normalQuantile(point[dimension++]) : 0;
  const double s = spread_.elevation ? normalQuantile(point[dimension]) : 0;
  BeamRay out = through(line, q, p, s);
  if (spread_.lateral && spread_.rays > 1) {
    const auto stratum = static_cast<std::size_t>(i);
    out.from_slope = lateral_slope_ * (strata_[stratum] - q);
    out.to_slope = lateral_slope_ * (strata_[stratum + 1] - q);
  }
  return out;
}

BeamRay BeamRays::through(const LineGeometry& line, double q, double p, double s) const {
  const Vec3d elevation{0, 1, 0};
  const Vec3d lateral = cross(elevation, line.direction);
  BeamRay out;
  out.lateral = lateral;
  Vec3d along = line.direction;
  if (spread_.lateral) {
    along = along + q * lateral_slope_ * lateral;
    out.half_square = q * q / 2;
  }
  if (spread_.elevation) {
    out.lens_m = p * lens_m_;
    along = along + (s * tilt_ - out.lens_m / focus_m_) * elevation;
    const double y = out.lens_m;
    out.start_m = y * y / (std::hypot(focus_m_, y) + focus_m_);
  }
  out.ray = {line.origin + out.lens_m * elevation, normalised(along)};
  return out;
}

void BeamRays::weights(const BeamRay& ray, std::span<float> out) const {
  DCHECK_EQ(out.size() + kWide, transmit_.size());
  // No normal number of beamPoint() is over 9, so no power is beyond the floats.
  const auto halvings = static_cast<float>(std::min(ray.half_square, 60.0) * std::numbers::log2e);
  const std::size_t size = out.size(), whole = size - size % kWide;
  const auto store = [&](std::size_t k, std::size_t bytes) {
    Block rho;
    std::memcpy(&rho, transmit_.data() + k, sizeof rho);
    const Block weight = powerOfHalf(rho * halvings);
    std::memcpy(out.data() + k, &weight, bytes);
  };
  for (std::size_t k = 0; k < whole; k += kWide) store(k, sizeof(Block));
  if (whole < size) store(whole, (size - whole) * sizeof(float));
}

}  // namespace echocine
