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

// The correlation of two blocks, from its definition.
long double correlationBetween(const std::vector<float>& a, int line, int sample,
                               const std::vector<float>& b, int to_line, int to_sample,
                               const BlockMatchSettings& s) {
  const auto sum = [&](const auto& term) {
    long double out = 0;
    for (int i = -s.half_lines; i <= s.half_lines; ++i)
      for (int k = -s.half_samples; k <= s.half_samples; ++k)
        out += term(a[static_cast<std::size_t>((line + i) * kBlockSamples + sample + k)],
                    b[static_cast<std::size_t>((to_line + i) * kBlockSamples + to_sample + k)]);
    return out;
  };
  const auto n = static_cast<long double>((2 * s.half_lines + 1) * (2 * s.half_samples + 1));
  const long double mean_a = sum([](float x, float) { return static_cast<long double>(x); }) / n,
                    mean_b = sum([](float, float y) { return static_cast<long double>(y); }) / n;
  const long double aa = sum([&](float x, float) { return (x - mean_a) * (x - mean_a); }),
                    bb = sum([&](float, float y) { return (y - mean_b) * (y - mean_b); }),
                    ab = sum([&](float x, float y) { return (x - mean_a) * (y - mean_b); });
  return ab / std::sqrt(aa * bb);
}

// Also at high levels, which nearly cancel, and near the borders, where some shifts leave the
// picture.
TEST(BlockMatch, TheBestShiftHasTheHighestCorrelationByDefinition) {
  const BlockMatchSettings s{4, 4, 6, 6};
  const std::vector<float> before = texture(0, 0);
  for (const double offset : {0.0, 300.0, 2e4}) {
    const std::vector<float> after = texture(1.3, -2.2, 2, offset);
    EXPECT_TRUE(matchBlock(planeOf(before), planeOf(after), 30, 60, s)) << offset;
    for (const int line : {4, 9, 30, 51, 55})
      for (const int sample : {4, 9, 60, 110, 115}) {
        long double best = -2;
        int best_line = 0, best_sample = 0;
        for (int i = -6; i <= 6; ++i)
          for (int k = -6; k <= 6; ++k) {
            if (line + i < 4 || line + i + 4 >= kBlockLines || sample + k < 4 ||
                sample + k + 4 >= kBlockSamples)
              continue;
            const long double found =
                correlationBetween(before, line, sample, after, line + i, sample + k, s);
            if (found > best) best = found, best_line = i, best_sample = k;
          }
        const auto match = matchBlock(planeOf(before), planeOf(after), line, sample, s);
        if (!match) continue;  // a neighbour of the best shift leaves the picture
        EXPECT_NEAR(match->correlation, static_cast<double>(best), 1e-9) << offset;
        EXPECT_NEAR(match->lines, best_line, 1) << line;
        EXPECT_NEAR(match->samples, best_sample, 1) << sample;
        const auto same = correlationInPlace(planeOf(before), planeOf(after), line, sample, s);
        ASSERT_TRUE(same);
        EXPECT_NEAR(
            *same,
            static_cast<double>(correlationBetween(before, line, sample, after, line, sample, s)),
            1e-9);
      }
  }
}

// A sum of numbers such as 0.1 is rounded. A constant block still has no correlation, at any level,
// nor is it taken for one beside others that are not constant.
TEST(BlockMatch, AConstantBlockHasNoCorrelation) {
  const BlockMatchSettings s{4, 4, 6, 6};
  const std::vector<float> before = texture(0, 0);
  for (const float level : {0.1f, 1.1f, 3e5f}) {
    const std::vector<float> constant(before.size(), level);
    EXPECT_FALSE(matchBlock(planeOf(constant), planeOf(before), 30, 60, s)) << level;
    EXPECT_FALSE(matchBlock(planeOf(before), planeOf(constant), 30, 60, s)) << level;
    EXPECT_FALSE(correlationInPlace(planeOf(constant), planeOf(before), 30, 60, s));
    EXPECT_FALSE(correlationInPlace(planeOf(before), planeOf(constant), 30, 60, s));
    std::vector<float> half = texture(0, 0);
    for (std::size_t i = 0; i < half.size(); ++i)
      if (i % kBlockSamples < 60) half[i] = level;
    // Shifts onto the constant half only, about the block's own place.
    EXPECT_FALSE(matchBlock(planeOf(before), planeOf(half), 30, 45, s)) << level;
    EXPECT_TRUE(matchBlock(planeOf(before), planeOf(half), 30, 80, s)) << level;
  }
}

}  // namespace
}  // namespace echocine
