// Frame rates as files want them: fractions.

#include <gtest/gtest.h>

#include "video/cine_writer.h"

namespace echocine {
namespace {

TEST(RationalFrameRate, IsTheFractionOneWouldWrite) {
  const auto expectRate = [](double rate_hz, int numerator, int denominator) {
    const Rational rate = rationalFrameRate(rate_hz);
    EXPECT_EQ(rate.numerator, numerator) << rate_hz;
    EXPECT_EQ(rate.denominator, denominator) << rate_hz;
  };
  expectRate(50, 50, 1);
  expectRate(1, 1, 1);
  expectRate(1000, 1000, 1);
  expectRate(12.5, 25, 2);
  expectRate(49.9, 499, 10);
  expectRate(0.5, 1, 2);
  expectRate(29.97, 30000, 1001);
  expectRate(30000.0 / 1001.0, 30000, 1001);
  expectRate(23.976, 24000, 1001);
  expectRate(59.94, 60000, 1001);
  expectRate(29.9, 299, 10);
  expectRate(100.0 / 3.0, 100, 3);
  expectRate(65.0 / 60.0 * 40, 130, 3);
}

TEST(RationalFrameRate, IsNearAnyRate) {
  for (double rate_hz = 0.01; rate_hz < 1e5; rate_hz *= 1.2345) {
    const Rational rate = rationalFrameRate(rate_hz);
    EXPECT_LE(rate.denominator, 1001);
    EXPECT_NEAR(static_cast<double>(rate.numerator) / rate.denominator, rate_hz, 5e-4);
  }
}

}  // namespace
}  // namespace echocine
