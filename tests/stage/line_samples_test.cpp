// From segments and echoes to samples.

#include "trace/line_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace echocine {
namespace {

const Sampling kSampling{0.01, 0.001, 100};  // 10..110 mm

LineTrace oneStretch(double begin_m, double end_m) {
  LineTrace line;
  line.segments.push_back({.begin_depth_m = begin_m,
                           .end_depth_m = end_m,
                           .begin_path_m = begin_m,
                           .strength_m2_sr = 2,
                           .medium = MediumId{3}});
  return line;
}

std::vector<float> sampled(const LineTrace& line, const IntensityTerms& parts = {}) {
  std::vector<float> values(100, -1.0f);
  sampleIntensity(line, kSampling, parts, values);
  return values;
}

// Sample k is centred at min_depth + (k + 1/2) spacing: half a sample off would shift every
// picture.
TEST(LineSamples, AStretchFillsTheSamplesWhoseCentresItHolds) {
  // Centres at 10.5, 11.5, ... mm; the beginning belongs to it and the end does not.
  const std::vector<float> values = sampled(oneStretch(0.0202, 0.0309));
  for (std::size_t k = 0; k < values.size(); ++k) EXPECT_EQ(values[k] > 0, k >= 10 && k <= 20) << k;
}

TEST(LineSamples, NeighbouringStretchesNeitherOverlapNorLeaveAGap) {
  for (const double cut : {0.0305, 0.03049, 0.0310, 0.0300}) {
    LineTrace line = oneStretch(0, cut);
    line.segments.push_back(oneStretch(cut, 1).segments[0]);
    line.segments[1].medium = MediumId{4};
    std::vector<std::uint32_t> ids(100);
    sampleMedium(line, kSampling, ids);
    for (std::size_t k = 0; k < 100; ++k)
      EXPECT_EQ(ids[k], kSampling.centre(static_cast<double>(k)) < cut ? 3u : 4u);
  }
}

// Law: intervals cover the depth once, so an echo falls into one sample, never two or none.
TEST(LineSamples, AnEchoGoesIntoTheSampleWhoseIntervalHoldsIt) {
  for (const auto& [depth_m, k] :
       {std::pair(0.0101, 0), {0.01999, 9}, {0.0500001, 40}, {0.1099, 99}}) {
    LineTrace line;
    line.echoes = {{depth_m, 0.25, 2}};
    const std::vector<float> values = sampled(line);
    EXPECT_FLOAT_EQ(values[static_cast<std::size_t>(k)], static_cast<float>(0.25 * std::exp(-2)));
    EXPECT_EQ(std::accumulate(values.begin(), values.end(), 0.0f),
              values[static_cast<std::size_t>(k)]);
  }
}

TEST(LineSamples, EchoesOutsideTheImageAreNowhere) {
  LineTrace line;
  line.echoes = {{0.0, 1, 0}, {0.0099, 1, 0}, {0.1101, 1, 0}, {5, 1, 0}};
  for (const float value : sampled(line)) EXPECT_EQ(value, 0.0f);
}

TEST(LineSamples, EchoesOfOneSampleAdd) {
  LineTrace line;
  line.echoes = {{0.0502, 0.25, 0}, {0.0507, 0.5, 0}};
  EXPECT_EQ(sampled(line)[40], 0.75f);
}

TEST(LineSamples, CellEchoesAreAddedToTheirSamplesAttenuatedAsTheirExponentSays) {
  std::vector<float> plane(500, 1.0f);
  CellEchoes echoes;
  echoes.reserve(300);
  for (std::uint32_t i = 0; i < 300; ++i) {
    echoes.at[i] = 499 - i;
    echoes.intensity[i] = 1e3 + i;
    echoes.exponent[i] = i < 290 ? 0.05 * i : 1e9;
  }
  echoes.count = 299;
  const std::vector<float> before = plane;
  addToSamples(echoes, {.reflection = false}, plane);
  EXPECT_EQ(plane, before);
  addToSamples(echoes, {}, plane);
  for (std::uint32_t i = 0; i < 299; ++i)
    EXPECT_FLOAT_EQ(plane[499 - i],
                    1 + static_cast<float>(echoes.intensity[i] * std::exp(-echoes.exponent[i])));
  EXPECT_EQ(plane[499 - 299], 1.0f);
  addToSamples(echoes, {.attenuation = false}, plane);
  EXPECT_FLOAT_EQ(plane[499 - 298], 1 + 1298.0f);
}

// Law: reflection.Y + backscatter.Y = Y.
TEST(LineSamples, PartsAddToTheWhole) {
  LineTrace line = oneStretch(0, 1);
  line.segments[0].exponent_per_m = 40;
  line.echoes = {{0.05, 3, 1}};
  const std::vector<float> whole = sampled(line), scattered = sampled(line, {.reflection = false}),
                           reflected = sampled(line, {.backscatter = false});
  for (std::size_t k = 0; k < whole.size(); ++k)
    EXPECT_FLOAT_EQ(whole[k], scattered[k] + reflected[k]);
}

// l = 0 would divide by 0: the first sample of a probe without a near limit.
TEST(LineSamples, ASampleAtTheTransducerIsFinite) {
  std::vector<float> values(1);
  sampleIntensity(oneStretch(0, 1), {0, 1e-6, 1}, {}, values);
  EXPECT_FLOAT_EQ(values[0], 2 / (5e-7f * 5e-7f));
}

TEST(LineSamples, BehindTheEndOfTheRayEverythingIsExactlyZero) {
  const std::vector<float> values = sampled(oneStretch(0, 0.05));
  std::vector<float> exponents(100, -1.0f);
  sampleExponent(oneStretch(0, 0.05), kSampling, exponents);
  for (std::size_t k = 40; k < 100; ++k) EXPECT_EQ(values[k] + exponents[k], 0.0f);
}

}  // namespace
}  // namespace echocine
