#include "fit/heart_prior.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "core/check.h"
#include "core/cholesky.h"
#include "core/hash_random.h"
#include "fit/dial_checks.h"

namespace echocine::fit {

namespace {

constexpr std::size_t kN = kPriorDialCount;
enum Row : std::size_t { kV, kS, kE, kW, kB, kC };

std::vector<double> covarianceOf(const HeartGroup& group) {
  std::vector<double> out(group.correlation.begin(), group.correlation.end());
  for (std::size_t i = 0; i < kHeartIndices; ++i)
    for (std::size_t j = 0; j < kHeartIndices; ++j)
      out[i * kHeartIndices + j] *= group.sd[i] * group.sd[j];
  return out;
}

}  // namespace

std::optional<std::size_t> priorDialOf(const std::string& key) {
  const auto found = std::find(kPriorDials.begin(), kPriorDials.end(), key);
  if (found == kPriorDials.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kPriorDials.begin());
}

double LonePrior::logDensity(double value) const {
  if (median == 0) return -0.5 * (value / spread) * (value / spread);
  const double z = std::log(value / median) / spread;
  return -0.5 * z * z - std::log(value);
}

const LonePrior* lonePriorOf(const std::string& key) {
  const auto* found = std::find_if(std::begin(kLonePriors), std::end(kLonePriors),
                                   [&](const LonePrior& prior) { return prior.key == key; });
  return found == std::end(kLonePriors) ? nullptr : found;
}

std::optional<double> HeartPrior::sdOf(const std::string& key) const {
  if (const LonePrior* lone = lonePriorOf(key)) return lone->sd();
  const auto p = priorDialOf(key);
  return p ? std::optional(sd_[*p]) : std::nullopt;
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
    normal.mean[i] = group.mean[heart::kIndexOfRow[i]];
    for (std::size_t j = 0; j < kN; ++j)
      normal.factor[i * kN + j] =
          covariance[heart::kIndexOfRow[i] * kHeartIndices + heart::kIndexOfRow[j]];
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
    const PriorDials d = heart::dialsOf(draw(0, n), body);
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
  const double edv = d[kEdv_ml], s = d[kSphericity], q = d[kConicity],
               length = heart::longAxis_mm(edv, s, q);
  // The Jacobian is triangular: its determinant is a constant times k / L^2.
  const double share = heart::sphereShare(q);
  const double constant =
      std::log(200 * share * 100 * 200 * heart::kPosteriorShare * 100 * 100 / kBodySurface_m2);
  if (gradient != nullptr) {
    PriorDials in_x{};
    for (std::size_t g = 0; g < 2; ++g)
      for (std::size_t i = 0; i < kN; ++i) in_x[i] += std::exp(logs[g] - total) * slopes[g][i];
    const double walls = in_x[kW] * x[kW], excursion = in_x[kB] * 100 * d[kMapse_mm] / length;
    // L goes as edv^(1/3) s^(-2/3) k^(-1/3).
    const double by_share = in_x[kS] * x[kS] + (walls + excursion + 5) / 3;
    *gradient = {
        100 * in_x[kE],          in_x[kV] / kBodySurface_m2 - (walls + excursion + 2) / (3 * edv),
        walls / d[kWall_mm],     (2 * in_x[kS] * x[kS] + (2 * excursion - walls + 4) / 3) / s,
        100 * in_x[kB] / length, 100 * in_x[kC] + heart::sphereShareSlope(q) * by_share};
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
