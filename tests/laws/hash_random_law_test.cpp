// Numbers that are hashes have the moments of their distributions.

#include "core/hash_random.h"

#include <gtest/gtest.h>

namespace echocine {
namespace {

constexpr int kDraws = 200000;

// The mean of n draws errs by 1/sqrt(n), the variance by sqrt(2/n), the fourth moment by
// sqrt(96/n): four times that is accepted.
TEST(HashRandomLaw, NormalNumbersHaveTheMomentsOfTheNormalDistribution) {
  double sum = 0, squares = 0, fourth = 0;
  int below = 0;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const double x = normalFromHashes(hashOf(i, 1), hashOf(i, 2));
    sum += x, squares += x * x, fourth += x * x * x * x;
    below += x < -1;
  }
  EXPECT_NEAR(sum / kDraws, 0, 4 * std::sqrt(1.0 / kDraws));
  EXPECT_NEAR(squares / kDraws, 1, 4 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(fourth / kDraws, 3, 4 * std::sqrt(96.0 / kDraws));
  EXPECT_NEAR(1.0 * below / kDraws, 0.158655, 4 * std::sqrt(0.1335 / kDraws));
}

TEST(HashRandomLaw, UniformNumbersFillTheUnitIntervalEvenly) {
  int tenths[10] = {};
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const double x = uniformFromHash(hashOf(i));
    ASSERT_TRUE(x > 0 && x < 1);
    ++tenths[static_cast<int>(10 * x)];
  }
  for (const int count : tenths) EXPECT_NEAR(count, 0.1 * kDraws, 4 * std::sqrt(0.09 * kDraws));
}

}  // namespace
}  // namespace echocine
