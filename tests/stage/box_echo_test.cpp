// A box of a loop in beam space: the widths of a known grain, what follows a motion and what does
// not, and how fast a grain that fades is forgotten.

#include "texture/box_echo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/hash_random.h"

namespace echocine {
namespace {

constexpr int kGrainLines = 90, kGrainSamples = 200;
constexpr double kLineDeviation = 1.5, kSampleDeviation = 2.5;

double unitGaussian(std::uint64_t hash) {  // Box and Muller's
  const double u = 1 - uniformFromHash(hash), v = uniformFromHash(hashOf(hash, 1));
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

// White noise of unit variance under a bell, moved by whole lines and samples.
std::vector<float> grain(int seed, int lines, int samples) {
  constexpr int kReachLines = 6, kReachSamples = 10;
  const auto white = [&](int i, int k) { return unitGaussian(hashOf(seed, i, k)); };
  std::vector<double> along(
      static_cast<std::size_t>((kGrainLines + 2 * kReachLines) * kGrainSamples));
  for (int i = 0; i < kGrainLines + 2 * kReachLines; ++i) {
    std::vector<double> row;
    for (int k = 0; k < kGrainSamples + 2 * kReachSamples; ++k)
      row.push_back(white(i - kReachLines - lines, k - kReachSamples - samples));
    for (int k = 0; k < kGrainSamples; ++k)
      for (int t = -kReachSamples; t <= kReachSamples; ++t)
        along[static_cast<std::size_t>(i * kGrainSamples + k)] +=
            std::exp(-0.5 * t * t / (kSampleDeviation * kSampleDeviation)) *
            row[static_cast<std::size_t>(k + kReachSamples + t)];
  }
  std::vector<float> plane;
  for (int i = 0; i < kGrainLines; ++i)
    for (int k = 0; k < kGrainSamples; ++k) {
      double sum = 0;
      for (int t = -kReachLines; t <= kReachLines; ++t)
        sum += std::exp(-0.5 * t * t / (kLineDeviation * kLineDeviation)) *
               along[static_cast<std::size_t>((i + kReachLines + t) * kGrainSamples + k)];
      plane.push_back(static_cast<float>(100 + sum));
    }
  return plane;
}

std::vector<BlockPlane> planesOf(const std::vector<std::vector<float>>& frames) {
  std::vector<BlockPlane> planes;
  for (const std::vector<float>& frame : frames)
    planes.push_back({.values = frame, .lines = kGrainLines, .samples = kGrainSamples});
  return planes;
}

constexpr BlockMatchSettings kReach{
    .half_lines = 1, .half_samples = 1, .search_lines = 3, .search_samples = 5};

// The autocovariance of white noise under a bell of deviation s is a bell of deviation sqrt(2) s.
TEST(BoxEcho, WidthsAreThoseOfTheGrain) {
  const double width = 2 * std::sqrt(2 * std::log(2.0)) * std::sqrt(2.0);
  double axial = 0, lateral = 0;
  constexpr int kSeeds = 6;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const std::vector<std::vector<float>> frames{grain(seed, 0, 0)};
    const BoxEcho echo = boxEcho(planesOf(frames), {2, 87, 2, 197}, 0, kReach);
    axial += echo.axial_samples / kSeeds;
    lateral += echo.lateral_lines / kSeeds;
    EXPECT_NEAR(echo.mean, 100, 3);
    EXPECT_TRUE(std::isnan(echo.tracked[0]));  // no later frame
  }
  EXPECT_NEAR(axial, width * kSampleDeviation, 0.05 * width * kSampleDeviation);
  EXPECT_NEAR(lateral, width * kLineDeviation, 0.05 * width * kLineDeviation);
}

// In place a shift (i, k) leaves the grain's autocorrelation; block matching finds it whole.
TEST(BoxEcho, AMotionIsFollowedAndInPlaceFollowsTheClosedForm) {
  std::vector<std::vector<float>> frames;
  for (int f = 0; f < 7; ++f) frames.push_back(grain(9, f, 2 * f));
  const BoxEcho echo = boxEcho(planesOf(frames), {25, 55, 50, 130}, 3, kReach);
  for (int lag = 1; lag <= kEchoLags; ++lag) {
    EXPECT_NEAR(echo.tracked[lag - 1], 1, 1e-6) << lag;
    const double u = lag / kLineDeviation, v = 2 * lag / kSampleDeviation;
    EXPECT_NEAR(echo.in_place[lag - 1], std::exp(-0.25 * (u * u + v * v)), 0.1) << lag;
  }
}

// Each frame keeps the share rho of the last and takes new grain for the rest: rho^lag is left.
TEST(BoxEcho, AGrainThatFadesIsForgottenByItsShare) {
  constexpr double kShare = 0.8;
  std::vector<std::vector<float>> frames{grain(0, 0, 0)};
  for (int f = 1; f < 12; ++f) {
    std::vector<float> next = grain(f, 0, 0);
    for (std::size_t i = 0; i < next.size(); ++i)
      next[i] =
          static_cast<float>(100 + kShare * (static_cast<double>(frames.back()[i]) - 100) +
                             std::sqrt(1 - kShare * kShare) * (static_cast<double>(next[i]) - 100));
    frames.push_back(std::move(next));
  }
  const BoxEcho echo = boxEcho(planesOf(frames), {10, 80, 20, 180}, 0, kReach);
  for (int lag = 1; lag <= kEchoLags; ++lag)
    EXPECT_NEAR(echo.in_place[lag - 1], std::pow(kShare, lag), 0.06) << lag;
}

TEST(BoxEcho, AnEvenBoxHasNoGrain) {
  const std::vector<std::vector<float>> frames(3,
                                               std::vector<float>(kGrainLines * kGrainSamples, 7));
  const BoxEcho echo = boxEcho(planesOf(frames), {10, 30, 20, 60}, 1, kReach);
  EXPECT_EQ(echo.mean, 7);
  EXPECT_EQ(echo.deviation, 0);
  EXPECT_TRUE(std::isnan(echo.axial_samples));
  EXPECT_TRUE(std::isnan(echo.tracked[0]));
  EXPECT_TRUE(std::isnan(echo.in_place[0]));
}

}  // namespace
}  // namespace echocine
