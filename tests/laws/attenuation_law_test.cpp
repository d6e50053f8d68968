// Eq. 3: units, additivity and the way there and back.

#include <gtest/gtest.h>

#include "support/plain_scene.h"

namespace echocine {
namespace {

using namespace support;

// dB of amplitude: 20 log10. The literature mixes this up with 10 log10 of intensity.
TEST(AttenuationUnits, OneNeperIsTwentyLogEDecibelsOfAmplitude) {
  EXPECT_DOUBLE_EQ(decibelsFromNepers(1), 20 * std::log10(std::exp(1.0)));
  EXPECT_NEAR(nepersFromDecibels(8.685889638065037), 1, 1e-15);
}

// One number taken there and back is itself.
TEST(AttenuationUnits, DecibelsAndNepersConvertBothWays) {
  for (const double db : {-120.0, 0.0, 1e-6, 0.52, 3.0, 60.0})
    EXPECT_DOUBLE_EQ(decibelsFromNepers(nepersFromDecibels(db)), db);
}

// alpha = a f^b, from dB/(cm MHz^b) to Np/m: exponents 1, 2 and 0.
TEST(AttenuationUnits, HalfADecibelPerCentimetreAndMegahertzAtTwoMegahertz) {
  EXPECT_NEAR(nepersPerMetre(0.5, 1, 2e6), 100 / 8.685889638065037, 1e-12);
  EXPECT_NEAR(nepersPerMetre(0.5, 2, 2e6), 200 / 8.685889638065037, 1e-12);
  EXPECT_NEAR(nepersPerMetre(0.5, 0, 7e6), 50 / 8.685889638065037, 1e-12);
}

// Relative intensity of the backscatter at one depth, spread left out.
double received(const Scene& scene, const std::vector<Crossing>& crossings) {
  const LineTrace line = walkStraight(straightSettings(scene), crossings);
  IntensityTerms parts;
  parts.spread_undone_at_m = 1;
  return intensityOf(line, samplingOf(scene.probe), parts).back();
}

Scene metreScene(const std::vector<Medium>& media) {
  Scene scene = plainScene(media);
  scene.probe.max_depth_m = 1.5;
  scene.probe.min_depth_m = 0.5;
  scene.probe.samples = 1;  // centred at 1 m
  scene.unit_volume_m3 = 1;
  return scene;
}

// Eq. 3 both ways: exp(-2 alpha l) squared.
TEST(Attenuation, OneNeperPerMetreOverOneMetreAndBackIsExpOfMinusFour) {
  EXPECT_NEAR(received(metreScene({medium("m", 1000, 1500, 1, 1)}), {}), std::exp(-4.0), 1e-8);
}

// A = 4 alpha l, not 2 alpha l: the mistake that is made most easily.
TEST(Attenuation, ThereAndBackIsTwiceTheForwardLoss) {
  const double alpha = 0.37, forward = std::exp(-2 * alpha * 1);
  EXPECT_NEAR(received(metreScene({medium("m", 1000, 1500, alpha, 1)}), {}), forward * forward,
              1e-7);
}

// Law: A(0, l) = A(0, c) + A(c, l), wherever a line is cut in two of the same medium.
TEST(Attenuation, PathsAddWhateverTheCuts) {
  Scene scene = metreScene({medium("a", 1000, 1500, 1.3, 1), medium("b", 1000, 1500, 1.3, 1)});
  addStructure(scene, 1, 1);
  const double whole = received(scene, {});
  for (const double cut : {1e-6, 0.1, 0.35, 0.5, 0.99})
    EXPECT_NEAR(received(scene, {crossingAt(cut, 0, true)}), whole, 1e-7 * whole) << cut;
}

// A = 4 sum(alpha_m l_m).
TEST(Attenuation, EachMediumLosesItsPart) {
  Scene scene = metreScene({medium("a", 1000, 1500, 0.5, 1), medium("b", 1000, 1500, 2, 1)});
  addStructure(scene, 1, 1);
  EXPECT_NEAR(received(scene, {crossingAt(0.25, 0, true), crossingAt(0.75, 0, false)}),
              std::exp(-4 * (0.5 * 0.5 + 2 * 0.5)), 1e-8);
}

// Law: Y = unattenuated.Y exp(-A) at every sample's centre, so any two of the channels give the
// third.
TEST(Attenuation, ExponentAndUnattenuatedIntensityMakeTheReceivedOne) {
  Scene scene = plainScene({medium("a", 1000, 1500, 5, 0.1), medium("b", 1060, 1500, 25, 0.7)});
  addStructure(scene, 1, 1);
  const LineTrace line = walkStraight(straightSettings(scene),
                                      {crossingAt(0.03, 0, true), crossingAt(0.09, 0, false)});
  const Sampling sampling = samplingOf(scene.probe);
  IntensityTerms without;
  without.attenuation = false;
  const std::vector<float> received = intensityOf(line, sampling),
                           free = intensityOf(line, sampling, without);
  std::vector<float> exponent(received.size());
  sampleExponent(line, sampling, exponent);
  for (std::size_t k = 0; k < received.size(); ++k) {
    if (k == 30 || k == 90) continue;  // their echoes lie elsewhere in the sample than its centre
    EXPECT_NEAR(received[k] / (free[k] * std::exp(-static_cast<double>(exponent[k]))), 1, 2e-6)
        << k;
  }
}

// exp(-A) leaves the range of floats at A = 103; up to 1e300 Np/m it must be 0, not a NaN of 0
// times infinity.
TEST(Attenuation, PastUnderflowThereIsNothingAndNeverNotANumber) {
  for (const double alpha : {1e2, 1e4, 1e8, 1e30, 1e300}) {
    Scene scene =
        plainScene({medium("a", 1000, 1500, alpha, 1), medium("b", 1060, 1500, alpha, 1)});
    scene.probe.samples = 1000;
    addStructure(scene, 1, 1);
    const LineTrace line = walkStraight(straightSettings(scene),
                                        {crossingAt(0.03, 0, true), crossingAt(0.09, 0, false)});
    for (const float value : intensityOf(line, samplingOf(scene.probe)))
      ASSERT_TRUE(std::isfinite(value) && value >= 0) << alpha;
    if (alpha >= 1e4) {
      EXPECT_EQ(intensityOf(line, samplingOf(scene.probe)).back(), 0.0f);
    }
  }
}

}  // namespace
}  // namespace echocine
