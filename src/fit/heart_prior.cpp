#include "fit/heart_prior.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.h"
#include "core/cholesky.h"
#include "core/hash_random.h"
#include "fit/dial_checks.h"
#include "motion/heart/wall_place.h"

namespace echocine::fit {

namespace {

constexpr std::size_t kN = kPriorDialCount;
// The parametric heart's mid inferolateral wall relative to its septum at end-diastole, and the
// rise of its apex relative to the long axis.
constexpr double kPosteriorShare = 0.85, kApexRise = 0.035;
// The indices that dials have, by row of indicesOf().
constexpr std::array<std::size_t, kN> kIndexOfRow{kVolumeIndex, kSphericityIndex, kEjectionIndex,
                                                  kWallIndex, kShorteningIndex};
enum Row : std::size_t { kV, kS, kE, kW, kB };

// c and k of indicesOf().
double volumeShare() {
  const heart::Meridian& outline = heart::wallOutline();
  return outline.volume() / (4 * outline.widest() * outline.widest());
}
double sphereShare() {
  return volumeShare() * 6 / std::numbers::pi;
}
double length_mm(double edv_ml, double sphericity) {
  return std::cbrt(1e3 * edv_ml / (volumeShare() * sphericity * sphericity));
}

std::vector<double> covarianceOf(const HeartGroup& group) {
  std::vector<double> out(group.correlation.begin(), group.correlation.end());
  for (std::size_t i = 0; i < kHeartIndices; ++i)
    for (std::size_t j = 0; j < kHeartIndices; ++j)
      out[i * kHeartIndices + j] *= group.sd[i] * group.sd[j];
  return out;
}

}  // namespace

const std::array<HeartGroup, 2>& heartGroups() {
  static const std::array<HeartGroup, 2> kGroups{{{"healthy",
                                                   0.5,
                                                   {67.8, 37.6, 62.9, 39.7, 74.4, 13.4},
                                                   {13.3, 7.8, 7.3, 9.5, 7.7, 3.6},
                                                   {1,     0.20,  -0.29, -0.33, 0,    0.04,  //
                                                    0.20,  1,     0,     -0.23, 0,    0,     //
                                                    -0.29, 0,     1,     0.06,  0.25, 0.34,  //
                                                    -0.33, -0.23, 0.06,  1,     0.29, 0,     //
                                                    0,     0,     0.25,  0.29,  1,    0.25,  //
                                                    0.04,  0,     0.34,  0,     0.25, 1}},
                                                  {"infarct",
                                                   0.5,
                                                   {96.5, 41.3, 41.3, 35.2, 70.3, 8.1},
                                                   {25.0, 8.6, 11.0, 8.4, 7.9, 3.3},
                                                   {1,     0.39,  -0.61, -0.46, 0,     -0.48,  //
                                                    0.39,  1,     -0.19, -0.48, -0.48, 0,      //
                                                    -0.61, -0.19, 1,     0.32,  0,     0.76,   //
                                                    -0.46, -0.48, 0.32,  1,     0.41,  0,      //
                                                    0,     -0.48, 0,     0.41,  1,     0,      //
                                                    -0.48, 0,     0.76,  0,     0,     1}}}};
  return kGroups;
}

PriorDials indicesOf(const PriorDials& d) {
  const double s = d[kSphericity], length = length_mm(d[kEdv_ml], s);
  return {d[kEdv_ml] / kBodySurface_m2, 100 * sphereShare() * s * s, 100 * d[kEf],
          200 * kPosteriorShare * d[kWall_mm] / (s * length),
          100 * (d[kMapse_mm] / length + kApexRise)};
}

PriorDials HeartPrior::dialsOf(const HeartIndices& indices, double body_surface_m2) {
  PriorDials d{};
  d[kEf] = indices[kEjectionIndex] / 100;
  d[kEdv_ml] = indices[kVolumeIndex] * body_surface_m2;
  d[kSphericity] = std::sqrt(std::max(0.0, indices[kSphericityIndex]) / (100 * sphereShare()));
  const double length = length_mm(d[kEdv_ml], d[kSphericity]);
  d[kWall_mm] = indices[kWallIndex] * d[kSphericity] * length / (200 * kPosteriorShare);
  d[kMapse_mm] = length * (indices[kShorteningIndex] / 100 - kApexRise);
  return d;
}

std::optional<std::size_t> priorDialOf(const std::string& key) {
  const auto found = std::find(kPriorDials.begin(), kPriorDials.end(), key);
  if (found == kPriorDials.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kPriorDials.begin());
}

HeartPrior::HeartPrior() {
  for (std::size_t g = 0; g < heartGroups().size(); ++g) {
    const std::vector<double> all = covarianceOf(heartGroups()[g]);
    factors_[g] = choleskyFactor(all, kHeartIndices);
    CHECK_EQ(factors_[g].empty(), false);
    normals_.push_back(normalOf(heartGroups()[g], all));
  }
  findMoments();
}

HeartPrior::Normal HeartPrior::normalOf(const HeartGroup& group,
                                        const std::vector<double>& covariance) {
  constexpr double kSpread = kBodySurfaceSd_m2 / kBodySurface_m2;
  Normal normal{
      std::log(group.share) - 0.5 * static_cast<double>(kN) * std::log(2 * std::numbers::pi),
      {},
      std::vector<double>(kN * kN)};
  for (std::size_t i = 0; i < kN; ++i) {
    normal.mean[i] = group.mean[kIndexOfRow[i]];
    for (std::size_t j = 0; j < kN; ++j)
      normal.factor[i * kN + j] = covariance[kIndexOfRow[i] * kHeartIndices + kIndexOfRow[j]];
  }
  // Variance of a product of independent numbers. Covariances with the other indices stay.
  normal.factor[0] =
      normal.factor[0] * (1 + kSpread * kSpread) + std::pow(normal.mean[0] * kSpread, 2);
  normal.factor = choleskyFactor(normal.factor, kN);
  for (std::size_t i = 0; i < kN; ++i) normal.log_scale -= std::log(normal.factor[i * kN + i]);
  return normal;
}

void HeartPrior::findMoments() {
  PriorDials sum{}, square{};
  int count = 0;
  constexpr std::uint64_t kDraws = 4000;
  for (std::uint64_t n = 0; n < kDraws; ++n) {
    const double body =
        kBodySurface_m2 + kBodySurfaceSd_m2 * normalFromHashes(hashOf(n, 71), hashOf(n, 72));
    const PriorDials d = dialsOf(draw(0, n), body);
    bool inside = true;
    for (std::size_t i = 0; i < kN; ++i) {
      const heart::Dial& dial = dialOf("prior", kPriorDials[i]);
      inside = inside && d[i] >= dial.low && d[i] <= dial.high;
    }
    if (!inside) continue;
    ++count;
    for (std::size_t i = 0; i < kN; ++i) sum[i] += d[i], square[i] += d[i] * d[i];
  }
  for (std::size_t i = 0; i < kN; ++i) {
    mean_[i] = sum[i] / count;
    sd_[i] = std::sqrt(square[i] / count - mean_[i] * mean_[i]);
  }
}

double HeartPrior::Normal::logAt(const PriorDials& x, PriorDials& slope) const {
  PriorDials z{};
  double log = log_scale;
  for (std::size_t i = 0; i < kN; ++i) {
    z[i] = x[i] - mean[i];
    for (std::size_t j = 0; j < i; ++j) z[i] -= factor[i * kN + j] * z[j];
    z[i] /= factor[i * kN + i];
    log -= 0.5 * z[i] * z[i];
  }
  for (std::size_t i = kN; i-- > 0;) {
    slope[i] = -z[i];
    for (std::size_t j = i + 1; j < kN; ++j) slope[i] -= factor[j * kN + i] * slope[j];
    slope[i] /= factor[i * kN + i];
  }
  return log;
}

double HeartPrior::logDensity(const PriorDials& d, PriorDials* gradient) const {
  const PriorDials x = indicesOf(d);
  std::array<double, 2> logs{};
  std::array<PriorDials, 2> slopes{};
  for (std::size_t g = 0; g < 2; ++g) logs[g] = normals_[g].logAt(x, slopes[g]);
  const double most = std::max(logs[0], logs[1]),
               total = most + std::log(std::exp(logs[0] - most) + std::exp(logs[1] - most));
  const double edv = d[kEdv_ml], s = d[kSphericity], length = length_mm(edv, s);
  // The Jacobian is triangular: its determinant is a constant over L^2.
  const double constant =
      std::log(200 * sphereShare() * 100 * 200 * kPosteriorShare * 100 / kBodySurface_m2);
  if (gradient != nullptr) {
    PriorDials in_x{};
    for (std::size_t g = 0; g < 2; ++g)
      for (std::size_t i = 0; i < kN; ++i) in_x[i] += std::exp(logs[g] - total) * slopes[g][i];
    const double walls = in_x[kW] * x[kW], excursion = in_x[kB] * 100 * d[kMapse_mm] / length;
    // L goes as edv^(1/3) s^(-2/3).
    *gradient = {100 * in_x[kE], in_x[kV] / kBodySurface_m2 - (walls + excursion + 2) / (3 * edv),
                 walls / d[kWall_mm], (2 * in_x[kS] * x[kS] + (2 * excursion - walls + 4) / 3) / s,
                 100 * in_x[kB] / length};
  }
  return total + constant - 2 * std::log(length);
}

HeartIndices HeartPrior::draw(std::size_t group, std::uint64_t seed, std::uint64_t number) const {
  HeartIndices z{}, out = heartGroups()[group].mean;
  for (std::size_t i = 0; i < kHeartIndices; ++i) {
    z[i] = normalFromHashes(hashOf(seed, number, i, 1), hashOf(seed, number, i, 2));
    for (std::size_t j = 0; j <= i; ++j) out[i] += factors_[group][i * kHeartIndices + j] * z[j];
  }
  return out;
}

HeartIndices HeartPrior::draw(std::uint64_t seed, std::uint64_t number) const {
  const bool healthy = uniformFromHash(hashOf(seed, number, 3)) < heartGroups()[0].share;
  return draw(healthy ? 0 : 1, seed, number);
}

}  // namespace echocine::fit
