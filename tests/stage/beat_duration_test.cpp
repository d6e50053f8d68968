// Beats that vary, and the random numbers behind them.

#include "motion/cycle/beat_duration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/hash_random.h"

namespace echocine {
namespace {

Acquisition varied(double variability, int seed = 1, double bpm = 60) {
  Acquisition a;
  a.heart_rate_hz = bpm / 60;
  a.rr_variability = variability;
  a.seed = seed;
  return a;
}

TEST(BeatDuration, IsTheMeanWithoutVariability) {
  for (int beat = 0; beat < 10; ++beat)
    EXPECT_EQ(beatDuration(varied(0, beat, 72), beat), 1 / (72.0 / 60));
}

// Of 10^5 beats the mean is known to 0.32 % of the deviation and the deviation to 0.22 %: four of
// each.
TEST(BeatDuration, HasTheMeanAndTheDeviationAskedForAndNeverThreeOfThem) {
  constexpr int kBeats = 100000;
  for (const double asked : {0.02, 0.1, 0.3})
    for (const int seed : {1, 2, 77}) {
      double sum = 0, squares = 0, product = 0, before = 0;
      int over_two = 0;
      for (int beat = 0; beat < kBeats; ++beat) {
        const double off = (beatDuration(varied(asked, seed), beat) - 1) / asked;
        ASSERT_LE(std::fabs(off), 3 + 1e-6);
        sum += off;
        squares += off * off;
        product += off * before;
        before = off;
        over_two += std::fabs(off) > 2 ? 1 : 0;
      }
      EXPECT_NEAR(sum / kBeats, 0, 0.013);
      EXPECT_NEAR(std::sqrt(squares / kBeats), 1, 0.009);
      EXPECT_NEAR(product / kBeats, 0, 0.013);  // neighbours are independent
      EXPECT_NEAR(static_cast<double>(over_two) / kBeats, 0.0462, 0.01);  // normal, cut at 3
    }
}

TEST(BeatDuration, DependsOnSeedAndBeatAlone) {
  std::set<double> durations;
  for (int seed = 0; seed < 20; ++seed)
    for (int beat = 0; beat < 50; ++beat) {
      const double s = beatDuration(varied(0.1, seed), beat);
      EXPECT_EQ(s, beatDuration(varied(0.1, seed), beat));
      durations.insert(s);
    }
  EXPECT_EQ(durations.size(), 1000u);
}

TEST(HashRandom, IsTheReferenceGeneratorsFinaliser) {
  // First output of splitmix64 seeded with 0 (Vigna's splitmix64.c).
  EXPECT_EQ(mixBits(0x9e3779b97f4a7c15ULL), 0xe220a8397b1dcdafULL);
  EXPECT_EQ(hashOf(0), 0xe220a8397b1dcdafULL);
  EXPECT_NE(hashOf(1, 2), hashOf(2, 1));
  EXPECT_NE(hashOf(0), hashOf(0, 0));
}

TEST(HashRandom, UniformNumbersFillEveryTenthAlikeAndReachNoEnd) {
  int tenth[10] = {};
  for (int i = 0; i < 100000; ++i) {
    const double u = uniformFromHash(hashOf(5, i));
    ASSERT_GT(u, 0);
    ASSERT_LT(u, 1);
    ++tenth[static_cast<int>(10 * u)];
  }
  for (const int count : tenth) EXPECT_NEAR(count, 10000, 5 * 95);
  EXPECT_GT(uniformFromHash(0), 0);
  EXPECT_LT(uniformFromHash(~0ULL), 1);
}

}  // namespace
}  // namespace echocine
