// The loop's one reference intensity: a percentile of all samples, against a sort.

#include "signal/reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "support/plain_scene.h"

namespace echocine {
namespace {

// 100 samples from 0 to 100 mm: the near field is the first 15.
Probe probe() {
  Probe p = support::plainScene({support::medium("m", 1000, 1500)}).probe;
  p.min_depth_m = 0;
  p.max_depth_m = 0.1;
  p.lines = 50;
  p.samples = 100;
  return p;
}

std::vector<float> randomPlane(unsigned seed) {
  std::mt19937 engine(seed);
  std::vector<float> plane(5000);
  for (float& v : plane) v = std::exp(static_cast<float>(engine() % 40000) / 1000 - 30);
  return plane;
}

std::vector<float> farField(const std::vector<float>& plane) {
  std::vector<float> kept;
  for (std::size_t i = 0; i < plane.size(); ++i)
    if (i % 100 >= 15) kept.push_back(plane[i]);
  return kept;
}

TEST(Reference, IsThePercentileOfASortToATenthOfAPercent) {
  std::vector<float> all;
  IntensityHistogram histogram(probe());
  for (unsigned seed = 0; seed < 20; ++seed) {
    const std::vector<float> plane = randomPlane(seed), far = farField(plane);
    histogram.add(plane);
    all.insert(all.end(), far.begin(), far.end());
  }
  std::sort(all.begin(), all.end());
  for (const double percent : {1.0, 50.0, 90.0, 99.0, 99.5, 99.99, 100.0}) {
    const auto rank =
        static_cast<std::size_t>(std::ceil(percent / 100 * static_cast<double>(all.size()))) - 1;
    const double found = histogram.percentile(percent);
    EXPECT_GE(found, all[rank]) << percent;
    EXPECT_LE(found, all[rank] * 1.001) << percent;
  }
}

// The first 15 % of depth is bright for the probe's sake, not the heart's.
TEST(Reference, LeavesTheNearFieldOut) {
  std::vector<float> plane(5000, 1.0f);
  for (std::size_t i = 0; i < plane.size(); ++i)
    if (i % 100 < 15) plane[i] = 1e6f;
  IntensityHistogram histogram(probe());
  histogram.add(plane);
  EXPECT_NEAR(histogram.percentile(100), 1, 1e-3);
}

TEST(Reference, IsOneWhenNothingIsBright) {
  IntensityHistogram histogram(probe());
  EXPECT_EQ(histogram.percentile(99.5), 1);
  histogram.add(std::vector<float>(5000, 0.0f));
  EXPECT_EQ(histogram.percentile(99.5), 1);
}

TEST(Reference, IsThatOfTheBrightSamplesWhenMostAreDark) {
  std::vector<float> plane(5000, 0.0f);
  plane[97] = 0.125f;
  plane[98] = 0.25f;
  plane[99] = 0.5f;
  IntensityHistogram histogram(probe());
  histogram.add(plane);
  EXPECT_NEAR(histogram.percentile(50), 0.25, 2.5e-4);
}

// Frames are measured in parallel; the same loop must have the same white.
TEST(Reference, DoesNotDependOnTheOrderOfFrames) {
  IntensityHistogram forwards(probe()), backwards(probe());
  for (unsigned i = 0; i < 9; ++i) {
    forwards.add(randomPlane(i));
    backwards.add(randomPlane(8 - i));
  }
  EXPECT_EQ(forwards.percentile(97), backwards.percentile(97));
}

}  // namespace
}  // namespace echocine
