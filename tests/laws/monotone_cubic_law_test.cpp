// A curve through knots: closed forms where the gaps differ.

#include "core/monotone_cubic.h"

#include <gtest/gtest.h>

namespace echocine {
namespace {

double slopeAt(const MonotoneCubic& curve, double x) {
  constexpr double kStep = 1e-5;
  return (curve(x + kStep) - curve(x - kStep)) / (2 * kStep);
}

// Fritsch and Butland's weighted harmonic mean of the secants d: d1 d2 / (a d2 + (1 - a) d1) with
// a = (h1 + 2 h2) / (3 (h1 + h2)). Here d1 = 1, d2 = 1/2, h1 = 1, h2 = 2, so a = 5/9.
TEST(MonotoneCubicLaw, TheSlopeAtAKnotWeighsTheSecantsByTheGaps) {
  EXPECT_NEAR(slopeAt(MonotoneCubic({{0, 0}, {1, 1}, {3, 2}}), 1), 9.0 / 13, 1e-4);
  EXPECT_NEAR(slopeAt(MonotoneCubic({{-3, -2}, {-1, -1}, {0, 0}}), -1), 9.0 / 13, 1e-4);
}

TEST(MonotoneCubicLaw, KnotsAndStraightLinesAreReproduced) {
  const MonotoneCubic line({{0, 1}, {1, 3}, {1.5, 4}, {4, 9}});
  for (const double x : {0.0, 0.3, 1.0, 1.2, 1.5, 2.9, 4.0})
    EXPECT_NEAR(line(x), 1 + 2 * x, 1e-12) << x;
  EXPECT_EQ(line(-1), 1);
  EXPECT_EQ(line(5), 9);
}

TEST(MonotoneCubicLaw, NothingIsPassedBetweenKnots) {
  const MonotoneCubic curve({{0, 0}, {0.1, 5}, {3, 5.1}, {3.2, 2}, {7, 0}});
  for (int i = 1; i <= 700; ++i) {
    const double change = curve(0.01 * i) - curve(0.01 * (i - 1));
    EXPECT_GE(i <= 300 ? change : -change, -1e-12) << i;
  }
}

}  // namespace
}  // namespace echocine
