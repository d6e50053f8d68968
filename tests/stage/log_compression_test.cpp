// Decibels to grey and back.

#include "signal/log_compression.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace echocine {
namespace {

float grey(float intensity, double reference = 1, double range_db = 60) {
  float out = -1;
  compressIntensities(std::span(&intensity, 1), reference, range_db, std::span(&out, 1));
  return out;
}

// Black is below the smallest normal float and white above the largest.
// The program's own logarithm takes floats apart, so all of their exponents are looked at.
TEST(LogCompression, AgreesWithLongDoubleOverTheWholeRangeOfFloats) {
  constexpr double kRange_db = 800;
  const double reference = 1e40;
  double worst = 0;
  for (float x = 1.2e-38f; x < 3e38f; x *= 1.0173f) {
    const long double exact = 1 + 10 * (std::log10(static_cast<long double>(x)) - 40) / kRange_db;
    worst = std::max(worst, static_cast<double>(std::abs(grey(x, reference, kRange_db) - exact)));
  }
  EXPECT_LT(worst, 2e-7);  // of 1: a float's rounding is 6e-8
  std::printf("worst error of grey %.2g\n", worst);
}

TEST(LogCompression, GreyIsThePositionInTheDynamicRange) {
  for (const double reference : {1.0, 3e-7, 2e9})
    for (const double range_db : {10.0, 60.0, 140.0})
      for (double down_db = 0.1; down_db < range_db; down_db += 0.37) {
        const auto intensity = static_cast<float>(reference * std::pow(10.0, -down_db / 10));
        const double exact =
            1 +
            10 * static_cast<double>(std::log10(static_cast<long double>(intensity) / reference)) /
                range_db;
        ASSERT_NEAR(grey(intensity, reference, range_db), exact,
                    1e-5 * std::max(1.0, 60 / range_db));
      }
}

TEST(LogCompression, EndsAreBlackAndWhite) {
  EXPECT_EQ(grey(1), 1.0f);
  EXPECT_EQ(grey(1e30f), 1.0f);
  EXPECT_EQ(grey(std::numeric_limits<float>::max()), 1.0f);
  EXPECT_EQ(grey(0.99e-6f), 0.0f);
  EXPECT_EQ(grey(1e-30f), 0.0f);
}

// log 0 is minus infinity, which a dynamic range cuts off to black.
TEST(LogCompression, NoIntensityIsBlackInEveryDynamicRange) {
  for (const double range_db : {1e-3, 60.0, 1000.0}) {
    EXPECT_EQ(grey(0, 1, range_db), 0.0f);
    EXPECT_EQ(grey(-0.0f, 1, range_db), 0.0f);
    EXPECT_EQ(grey(std::numeric_limits<float>::denorm_min(), 1, range_db), 0.0f);
  }
}

// Brighter tissue may never come out darker, not even by a rounding.
TEST(LogCompression, IsMonotone) {
  float last = 0;
  for (float x = 1e-7f; x < 2; x = std::nextafter(x * 1.00002f, 10.0f)) {
    const float now = grey(x);
    ASSERT_GE(now, last) << x;
    last = now;
  }
  for (float x = 0.0999f; x < 0.1001f; x = std::nextafter(x, 1.0f))
    ASSERT_LE(grey(x), grey(std::nextafter(x, 1.0f)));
}

TEST(LogCompression, UndoesTheExponential) {
  for (double level = 0.01; level < 1; level += 0.01) {
    const auto intensity = static_cast<float>(3e-7 * std::pow(10, (level - 1) * 6));
    EXPECT_NEAR(grey(intensity, 3e-7, 60), level, 1e-5);
  }
}

TEST(LogCompression, WorksInPlace) {
  std::vector<float> plane{1, 1e-3f, 0};
  compressIntensities(plane, 1, 60, plane);
  EXPECT_NEAR(plane[1], 0.5, 1e-5);
  EXPECT_EQ(plane[0] + plane[2], 1.0f);
}

}  // namespace
}  // namespace echocine
