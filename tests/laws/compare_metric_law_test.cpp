// Metrics and grey calibration against closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "compare/calibration.h"
#include "compare/frame_discrepancy.h"
#include "core/hash_random.h"
#include "metrics/frame_metrics.h"

namespace echocine::compare {

using namespace echo;
namespace {

constexpr int kLines = 40, kSamples = 60;

std::vector<float> waves(double phase, double contrast = 60, double mean = 120) {
  std::vector<float> out;
  for (int i = 0; i < kLines; ++i)
    for (int k = 0; k < kSamples; ++k)
      out.push_back(static_cast<float>(mean + contrast * std::sin(0.35 * i + phase) *
                                                  std::cos(0.22 * k - 0.1 * i)));
  return out;
}

std::vector<float> noise(std::uint64_t seed, double deviation) {
  std::vector<float> out;
  for (std::uint64_t i = 0; i < kLines * kSamples; ++i)
    out.push_back(static_cast<float>(
        128 + deviation * normalFromHashes(hashOf(seed, i, 1), hashOf(seed, i, 2))));
  return out;
}

const std::vector<float> kOnes(kLines* kSamples, 1.0f);

BeamPair pair(const std::vector<float>& x, const std::vector<float>& y,
              const std::vector<float>& w = kOnes) {
  return {x, y, w, kLines, kSamples};
}

// RMS 0, PSNR infinite, NCC, SSIM and gradient correlation 1.
TEST(CompareMetrics, EqualFramesArePerfect) {
  const std::vector<float> x = waves(0);
  const FrameMetrics m = frameMetrics(pair(x, x));
  EXPECT_EQ(m.rms, 0);
  EXPECT_EQ(m.mean_absolute, 0);
  EXPECT_TRUE(std::isinf(m.psnr_db));
  EXPECT_EQ(m.ncc, 1);
  EXPECT_NEAR(m.ssim, 1, 1e-12);
  EXPECT_EQ(m.histogram_distance, 0);
  EXPECT_EQ(m.gradient_correlation, 1);
}

// RMS and mean difference are the offset, NCC does not see it.
TEST(CompareMetrics, AConstantOffsetHasClosedForms) {
  const std::vector<float> x = waves(0);
  std::vector<float> y = x;
  for (float& v : y) v += 16;
  const FrameMetrics m = frameMetrics(pair(x, y));
  EXPECT_NEAR(m.rms, 16, 1e-6);
  EXPECT_NEAR(m.mean_absolute, 16, 1e-6);
  EXPECT_NEAR(m.psnr_db, 20 * std::log10(255.0 / 16), 1e-6);
  EXPECT_NEAR(m.ncc, 1, 1e-9);
  EXPECT_NEAR(m.histogram_distance, 16, 1e-6);
  EXPECT_NEAR(m.gradient_correlation, 1, 1e-9);
}

// Correlations are blind to gain and offset, and turn their sign with a negative.
TEST(CompareMetrics, ContrastBrightnessAndTheirSignInCorrelations) {
  const std::vector<float> x = waves(0);
  std::vector<float> dim = x, negative = x;
  for (float& v : dim) v = 0.4f * v + 20;
  for (float& v : negative) v = 255 - v;
  EXPECT_NEAR(frameMetrics(pair(x, dim)).ncc, 1, 1e-6);
  EXPECT_NEAR(frameMetrics(pair(x, negative)).ncc, -1, 1e-6);
  EXPECT_NEAR(frameMetrics(pair(x, negative)).gradient_correlation, -1, 1e-6);
}

// Two constant frames: SSIM is the luminance term alone.
TEST(CompareMetrics, SsimOfConstantsIsTheLuminanceTerm) {
  const std::vector<float> x(kOnes.size(), 100.0f), y(kOnes.size(), 140.0f);
  const double c1 = 0.01 * 255 * 0.01 * 255;
  EXPECT_NEAR(structuralSimilarity(pair(x, y)), (2 * 100 * 140 + c1) / (100 * 100 + 140 * 140 + c1),
              1e-5);
}

// NCC and mutual information tend to 0 with the number of samples.
TEST(CompareMetrics, IndependentNoiseHasNothingInCommon) {
  const FrameMetrics m = frameMetrics(pair(noise(1, 30), noise(2, 30)));
  EXPECT_NEAR(m.ncc, 0, 0.06);
  EXPECT_NEAR(m.gradient_correlation, 0, 0.06);
  EXPECT_NEAR(m.rms, 30 * std::sqrt(2.0), 1.5);
}

// Of two greys in equal shares that stand for one another: one bit.
// H(coin) = 1 bit: what a picture of two greys tells of itself.
TEST(CompareMetrics, MutualInformationOfACoinIsOneBit) {
  std::vector<float> x, y;
  for (int i = 0; i < kLines * kSamples; ++i) {
    x.push_back(i % 2 ? 200.0f : 40.0f);
    y.push_back(i % 2 ? 10.0f : 90.0f);
  }
  EXPECT_NEAR(frameMetrics(pair(x, y)).mutual_information, 1, 1e-12);
}

// What weighs nothing may hold anything.
TEST(CompareMetrics, SamplesOutsideTheAreaDoNotCount) {
  const std::vector<float> x = waves(0);
  std::vector<float> y = x, weights = kOnes;
  for (std::size_t i = 0; i < y.size(); i += 1)
    if (i % kSamples < 20) y[i] = 250, weights[i] = 0;
  const FrameMetrics m = frameMetrics(pair(x, y, weights));
  EXPECT_EQ(m.rms, 0);
  EXPECT_EQ(m.ncc, 1);
  EXPECT_EQ(m.gradient_correlation, 1);
  EXPECT_NEAR(m.ssim, 1, 1e-6);
  EXPECT_EQ(frameMetrics(pair(x, y, std::vector<float>(x.size(), 0))).weight, 0);
}

// Beam space of 80 degrees from 2 to 15 cm, all of it weighing its area.
const BeamGrid kSector{
    .lines = 90, .samples = 200, .first_rad = -0.7, .last_rad = 0.7, .near = 0.02, .far = 0.15};

std::vector<float> sectorWeights() {
  const PixelPlane all(kSector.size(), 1);
  return areaWeights(kSector, all, all);
}

// Greys of a function of the point (x, z) in cm.
std::vector<float> drawn(const std::function<double(double, double)>& grey) {
  std::vector<float> out;
  for (int i = 0; i < kSector.lines; ++i)
    for (int k = 0; k < kSector.samples; ++k)
      out.push_back(static_cast<float>(grey(100 * kSector.depth(k) * std::sin(kSector.angle(i)),
                                            100 * kSector.depth(k) * std::cos(kSector.angle(i)))));
  return out;
}

double edgeCorrelationOf(const std::vector<float>& x, const std::vector<float>& y) {
  const std::vector<float> weights = sectorWeights();
  const WallEdges edges(kSector, weights);
  return edgeCorrelation(edges(x), edges(y));
}

std::vector<float> rings(double x0, double z0) {
  return drawn(
      [=](double x, double z) { return 120 + 60 * std::sin(2 * std::hypot(x - x0, z - z0)); });
}

// G is a cosine between gradient fields: 1, and -1 where bright and dark change places.
TEST(EdgeCorrelation, EqualFramesAreOneAndNegativesMinusOne) {
  const std::vector<float> x = rings(1, 8);
  std::vector<float> dim = x, negative = x;
  for (float& v : dim) v = 0.4f * v + 20;
  for (float& v : negative) v = 255 - v;
  EXPECT_EQ(edgeCorrelationOf(x, x), 1);
  EXPECT_NEAR(edgeCorrelationOf(x, dim), 1, 1e-6);
  EXPECT_NEAR(edgeCorrelationOf(x, negative), -1, 1e-6);
  EXPECT_EQ(discrepancyOf(edgeCorrelationOf(x, x), 1), 0);
}

// PixelPlane waves across and along: their gradients stand at right angles everywhere.
// g_x . g_y = 0 everywhere.
TEST(EdgeCorrelation, EdgesAtRightAnglesHaveNothingInCommon) {
  const auto across = drawn([](double x, double) { return 128 + 50 * std::sin(1.5 * x); }),
             along = drawn([](double, double z) { return 128 + 50 * std::sin(1.5 * z); });
  EXPECT_NEAR(edgeCorrelationOf(across, along), 0, 0.02);
}

// sin(k x) against sin(k (x - d)): the mean of cos(k x) cos(k (x - d)) is cos(k d) times that of
// cos^2, over many waves.
// A wave against itself shifted by s correlates as cos(2 pi s / wavelength).
TEST(EdgeCorrelation, AShiftedWaveFollowsTheCosine) {
  const double k = 2.5;  // per cm
  const auto wave = [k](double d) {
    return drawn([=](double x, double) { return 128 + 50 * std::sin(k * (x - d)); });
  };
  for (const double d : {0.1, 0.3, 0.6, 1.0})
    EXPECT_NEAR(edgeCorrelationOf(wave(0), wave(d)), std::cos(k * d), 0.05) << d;
}

// A gain that falls by half over the depth and to the sides.
// A gain that changes over the whole depth has small gradients against a wall's.
TEST(EdgeCorrelation, SlowGainsHardlyCount) {
  std::vector<float> x = rings(1, 8), y = x;
  for (int i = 0; i < kSector.lines; ++i)
    for (int k = 0; k < kSector.samples; ++k)
      y[static_cast<std::size_t>(i * kSector.samples + k)] *= static_cast<float>(
          (1 - 0.5 * k / kSector.samples) * (1 - 0.5 * std::abs(kSector.angle(i)) / 0.7));
  EXPECT_GT(edgeCorrelationOf(x, y), 0.9);
}

// Two even frames are equal, 1; an even one says nothing of one with walls, 0.
TEST(EdgeCorrelation, FramesWithoutEdges) {
  const std::vector<float> flat(kSector.size(), 100), grey(kSector.size(), 30), x = rings(0, 8);
  EXPECT_EQ(edgeCorrelationOf(flat, grey), 1);
  EXPECT_EQ(edgeCorrelationOf(flat, x), 0);
}

// What weighs nothing may hold anything.
TEST(EdgeCorrelation, SamplesOutsideTheAreaDoNotCount) {
  const std::vector<float> x = rings(1, 8);
  std::vector<float> y = x, weights = sectorWeights();
  for (std::size_t i = 0; i < y.size(); ++i)
    if (i % static_cast<std::size_t>(kSector.samples) < 60) y[i] = 250, weights[i] = 0;
  const WallEdges edges(kSector, weights);
  EXPECT_EQ(edgeCorrelation(edges(x), edges(y)), 1);
}

// Else two loops that were pushed apart would be the most alike.
TEST(CompareMetrics, WhatRegistrationMovesOutOfSightCountsAsUnlike) {
  EXPECT_EQ(discrepancyOf(1, 0.75), 0.25);
  const std::vector<float> all(10, 1.0f), half{1, 1, 1, 1, 1, 0, 0, 0, 0, 0};
  EXPECT_EQ(overlapShare(all, half, 1), 0.5);
  EXPECT_EQ(overlapShare(all, half, 2), 1);  // twice as large: the same half fills all
}

// By hand, and of a straight line that the curve had no part in making.
TEST(GreyCalibration, TheCurveIsLinearBetweenItsKnots) {
  const GreyCurve curve{{0, 100, 200}, {10, 50, 250}};
  for (const auto& [grey, wanted] : std::initializer_list<std::pair<double, double>>{
           {-5, 10}, {0, 10}, {25, 20}, {100, 50}, {175, 200}, {200, 250}, {300, 250}})
    EXPECT_NEAR(curve(grey), wanted, 1e-12) << grey;
  std::vector<float> synthetic, real;
  for (int grey = 0; grey <= 200; ++grey) {
    synthetic.push_back(static_cast<float>(grey));
    real.push_back(static_cast<float>(3 + 0.5 * grey));
  }
  CalibrationFit fit({0, 60, 200});
  fit.add(synthetic, real, std::vector<float>(synthetic.size(), 1));
  const GreyCurve line = fit.solve(false);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(line.values[k], 3 + 0.5 * line.knots[k], 1e-6);
}

// Least squares without noise give back the curve itself.
TEST(GreyCalibration, AKnownCurveIsFoundAgain) {
  const GreyCurve truth{{0, 60, 130, 200, 255}, {12, 90, 70, 180, 240}};
  const std::vector<float> x = noise(3, 60);
  std::vector<float> y;
  for (const float v : x) y.push_back(static_cast<float>(truth(v)));
  CalibrationFit fit(truth.knots);
  fit.add(x, y, kOnes);
  const GreyCurve found = fit.solve(false);
  for (std::size_t i = 1; i + 1 < 5; ++i) EXPECT_NEAR(found.values[i], truth.values[i], 1e-3) << i;
  const GreyCurve rising = fit.solve(true);
  for (std::size_t i = 1; i < 5; ++i) EXPECT_GE(rising.values[i], rising.values[i - 1] - 1e-9);
}

// Where the best curve rises anyway, asking for a rising one changes nothing.
// The constraint is not active, so both minima are one.
TEST(GreyCalibration, MonotoneEqualsFreeWhereItRises) {
  const GreyCurve truth{{10, 80, 170, 250}, {5, 40, 190, 210}};
  const std::vector<float> x = noise(4, 55), e = noise(5, 4);
  std::vector<float> y;
  for (std::size_t i = 0; i < x.size(); ++i)
    y.push_back(static_cast<float>(truth(x[i])) + e[i] - 128);
  CalibrationFit fit(truth.knots);
  fit.add(x, y, kOnes);
  const GreyCurve a = fit.solve(false), b = fit.solve(true);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(a.values[i], b.values[i], 1e-4);
  EXPECT_NEAR(a.values[2], 190, 1);
}

// The least squares of a falling line among rising ones is its mean.
// The best curve that never falls, of data that only fall, is flat.
TEST(GreyCalibration, MonotoneOfAFallingLineIsItsMean) {
  std::vector<float> x, y, w;
  double sum = 0;
  for (int i = 0; i <= 200; ++i) {
    x.push_back(static_cast<float>(i));
    y.push_back(static_cast<float>(220 - i));
    w.push_back(1);
    sum += 220 - i;
  }
  CalibrationFit fit({0, 50, 100, 150, 200});
  fit.add(x, y, w);
  for (const double v : fit.solve(true).values) EXPECT_NEAR(v, sum / 201, 1e-6);
}

// Greys 255 sqrt(u) of even u have their quantiles at 255 sqrt(share).
TEST(GreyCalibration, KnotsHoldEqualShares) {
  std::vector<float> x;
  for (int i = 0; i < 10000; ++i)
    x.push_back(static_cast<float>(255.0 * std::sqrt((i + 0.5) / 10000)));
  const std::vector<float> w(x.size(), 1);
  const std::vector<float>* frames[] = {&x};
  const std::vector<double> knots = quantileKnots(frames, w, 5);
  ASSERT_EQ(knots.size(), 5u);
  for (int i = 1; i < 4; ++i)
    EXPECT_NEAR(knots[static_cast<std::size_t>(i)], 255 * std::sqrt(i / 4.0), 1);
}

}  // namespace
}  // namespace echocine::compare
