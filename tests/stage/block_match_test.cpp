// A block found again: whole shifts exactly, shifts between samples closely, no answer without one.

#include "metrics/block_match.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/hash_random.h"

namespace echocine {
namespace {

constexpr int kBlockLines = 60, kBlockSamples = 120;

// A sum of waves, several to a block, none of whose beats repeats in the search.
double textureAt(double line, double sample) {
  double sum = 0;
  for (int wave = 0; wave < 24; ++wave) {
    const double fi = 0.9 * (uniformFromHash(hashOf(wave, 1)) - 0.5),
                 fk = 0.9 * (uniformFromHash(hashOf(wave, 2)) - 0.5);
    sum += std::cos(fi * line + fk * sample + 6.28 * uniformFromHash(hashOf(wave, 3)));
  }
  return sum;
}

std::vector<float> texture(double lines, double samples, double gain = 1, double offset = 0) {
  std::vector<float> plane;
  for (int i = 0; i < kBlockLines; ++i)
    for (int k = 0; k < kBlockSamples; ++k)
      plane.push_back(static_cast<float>(gain * textureAt(i - lines, k - samples) + offset));
  return plane;
}

BlockPlane planeOf(const std::vector<float>& values) {
  return {.values = values, .lines = kBlockLines, .samples = kBlockSamples};
}

TEST(BlockMatch, AWholeShiftIsFoundWithAFullCorrelationWhateverGainAndOffset) {
  const std::vector<float> before = texture(0, 0), after = texture(3, -7, 2.5, 40);
  const auto match = matchBlock(planeOf(before), planeOf(after), 30, 60);
  ASSERT_TRUE(match);
  EXPECT_NEAR(match->lines, 3, 0.05);
  EXPECT_NEAR(match->samples, -7, 0.05);
  EXPECT_NEAR(match->correlation, 1, 1e-6);
}

TEST(BlockMatch, AShiftBetweenSamplesIsFoundToATwentieth) {
  for (const double part : {-0.4, -0.2, 0.1, 0.3, 0.45}) {
    const std::vector<float> before = texture(0, 0), after = texture(2 + part, 5 - part);
    const auto match = matchBlock(planeOf(before), planeOf(after), 30, 60);
    ASSERT_TRUE(match);
    EXPECT_NEAR(match->lines, 2 + part, 0.05) << part;
    EXPECT_NEAR(match->samples, 5 - part, 0.05) << part;
    EXPECT_GT(match->correlation, 0.95);
  }
}

TEST(BlockMatch, NothingIsFoundWhereNoShiftCanBeTold) {
  const std::vector<float> before = texture(0, 0), even(before.size(), 2.0f);
  EXPECT_FALSE(matchBlock(planeOf(even), planeOf(before), 30, 60));   // an even block
  EXPECT_FALSE(matchBlock(planeOf(before), planeOf(even), 30, 60));   // nothing to find it in
  EXPECT_FALSE(matchBlock(planeOf(before), planeOf(before), 7, 60));  // beyond the picture
  EXPECT_FALSE(matchBlock(planeOf(before), planeOf(before), 8, 60));  // no line to its left
  const std::vector<float> far = texture(9, 0);
  EXPECT_FALSE(matchBlock(planeOf(before), planeOf(far), 30, 60,
                          {.half_lines = 8,
                           .half_samples = 16,
                           .search_lines = 2,
                           .search_samples = 12}));  // may lie beyond what is searched
}

}  // namespace
}  // namespace echocine
