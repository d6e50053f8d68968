// The inverse curvature that slopes at successive places correct.

#include "fit/secant_covariance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/cholesky.h"
#include "core/hash_random.h"

namespace echocine::fit {
namespace {

using Numbers = std::vector<double>;

constexpr std::size_t kN = 5;

// Units of the unknowns, as different as a share and millilitres.
constexpr double kUnit[kN] = {0.01, 20, 1, 0.05, 3};

Numbers product(const Numbers& matrix, const Numbers& x) {
  Numbers out(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; j < x.size(); ++j) out[i] += matrix[i * x.size() + j] * x[j];
  return out;
}
double dot(const Numbers& a, const Numbers& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// Independent unknowns with these curvatures, in their units.
Numbers diagonal(const Numbers& curvature, bool inverse) {
  Numbers out(kN * kN);
  for (std::size_t i = 0; i < kN; ++i) {
    const double h = curvature[i] / (kUnit[i] * kUnit[i]);
    out[i * kN + i] = inverse ? 1 / h : h;
  }
  return out;
}
Numbers drawn(std::uint64_t seed, double width) {
  Numbers out;
  for (std::size_t i = 0; i < kN; ++i)
    out.push_back(width * kUnit[i] * normalFromHashes(hashOf(seed, i, 0), hashOf(seed, i, 1)));
  return out;
}
void expectSymmetricAndPositive(const Numbers& c) {
  for (std::size_t i = 0; i < kN; ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_EQ(c[i * kN + j], c[j * kN + i]);
  EXPECT_FALSE(choleskyFactor(c, kN).empty());
}

TEST(FitSecant, TheCovarianceTakesTheChangeOfTheSlopesToTheStep) {
  const Numbers h = diagonal({3, 0.7, 1, 2, 1.5}, false);
  SecantCovariance secant(diagonal({1, 1, 1, 1, 1}, true));
  const Numbers from = drawn(1, 1), to = drawn(2, 1);
  secant.add(from, product(h, from));
  EXPECT_EQ(secant.covariance(), diagonal({1, 1, 1, 1, 1}, true));  // one place has no step
  secant.add(to, product(h, to));
  Numbers s, y;
  const Numbers at = product(h, to), before = product(h, from);
  for (std::size_t i = 0; i < kN; ++i) s.push_back(to[i] - from[i]), y.push_back(at[i] - before[i]);
  const Numbers step = product(secant.covariance(), y);
  for (std::size_t i = 0; i < kN; ++i) EXPECT_NEAR(step[i], s[i], 1e-12 * kUnit[i]);
  expectSymmetricAndPositive(secant.covariance());
}

// Steps of Newton's method with curvatures that are off by factors of 0.6 to 3.5: the error along
// the steepest unknown grows by 2.5 a step, and with the correction it is gone.
TEST(FitSecant, StepsThatWouldOscillateConverge) {
  const Numbers h = diagonal({3.5, 0.6, 1, 2, 1}, false);
  for (const bool corrected : {false, true}) {
    Numbers at = drawn(3, 1);
    const Numbers first = diagonal({1, 1, 1, 1, 1}, true);
    SecantCovariance secant(first);
    for (int step = 0; step < 6; ++step) {
      const Numbers slopes = product(h, at);
      if (corrected) secant.add(at, slopes);
      const Numbers move = product(corrected ? secant.covariance() : first, slopes);
      for (std::size_t i = 0; i < kN; ++i) at[i] -= move[i];
    }
    const double left = std::sqrt(dot(at, product(diagonal({1, 1, 1, 1, 1}, false), at)));
    if (corrected)
      EXPECT_LT(left, 0.1);
    else
      EXPECT_GT(left, 50);
  }
}

// Along a step, the curvature becomes that of the slopes, within limits: a slope that falls where
// it should rise is noise.
TEST(FitSecant, TheCurvatureAlongAStepStaysWithinItsLimits) {
  const Numbers first = diagonal({1, 1, 1, 1, 1}, true);
  const Numbers step{kUnit[0], 0, 0, 0, 0};
  for (const double ratio : {-3.0, 0.0, 0.2, 0.5, 1.0, 2.5, 4.0, 9.0}) {
    SecantCovariance secant(first);
    secant.add(Numbers(kN), Numbers(kN));
    Numbers slopes = drawn(4, 0);
    slopes[0] = ratio / kUnit[0];
    secant.add(step, slopes);
    const double along = kUnit[0] * kUnit[0] / secant.covariance()[0];
    EXPECT_NEAR(along,
                std::clamp(ratio, SecantCovariance::kLeastRatio, SecantCovariance::kMostRatio),
                1e-9);
    expectSymmetricAndPositive(secant.covariance());
  }
}

TEST(FitSecant, NoiseKeepsItPositiveAndShortStepsChangeNothing) {
  const Numbers first = diagonal({1, 2, 1, 0.5, 1}, true);
  SecantCovariance noisy(first), still(first);
  for (std::uint64_t i = 0; i < 40; ++i) {
    Numbers slopes = drawn(100 + i, 3);
    for (std::size_t u = 0; u < kN; ++u) slopes[u] /= kUnit[u] * kUnit[u];
    noisy.add(drawn(i, 1), slopes);
    still.add(drawn(i, 0.02), slopes);
    expectSymmetricAndPositive(noisy.covariance());
  }
  EXPECT_NE(noisy.covariance(), first);
  EXPECT_EQ(still.covariance(), first);
}

}  // namespace
}  // namespace echocine::fit
