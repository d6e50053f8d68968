// Eqs. 5-7 against long double.

#include "scene/backscatter_law.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/units.h"
#include "scene/scene_reader.h"
#include "support/scene_text.h"

namespace echocine {
namespace {

constexpr long double kPi = std::numbers::pi_v<long double>;

// Eq. 5: both contrasts are 0.
TEST(ParticleBackscatter, AParticleEqualToItsFluidSendsNothingBack) {
  EXPECT_EQ(particleBackscatter(1e4, 3e-6, 4e-10, 4e-10, 1030, 1030), 0);
}

// Rayleigh: k^4 a^6.
TEST(ParticleBackscatter, GrowsWithTheFourthPowerOfFrequencyAndTheSixthOfTheRadius) {
  const double one = particleBackscatter(1e4, 3e-6, 3.4e-10, 4.1e-10, 1092, 1021);
  EXPECT_GT(one, 0);
  EXPECT_NEAR(particleBackscatter(2e4, 3e-6, 3.4e-10, 4.1e-10, 1092, 1021) / one, 16, 1e-12);
  EXPECT_NEAR(particleBackscatter(1e4, 6e-6, 3.4e-10, 4.1e-10, 1092, 1021) / one, 64, 1e-12);
}

// Eq. 5 at 180 degrees, where the cosine is -1, for softer and harder, lighter and heavier
// particles.
TEST(ParticleBackscatter, AgreesWithLongDouble) {
  for (const double G_e : {1e-12, 3.4e-10, 5e-10})
    for (const double rho_e : {1.0, 1092.0, 8000.0}) {
      const long double k = 1.2e4L, a = 2.75e-6L, G = 4.09e-10, rho = 1021;
      const long double contrast = (static_cast<long double>(G_e) - G) / G -
                                   3 * (rho_e - rho) / (2 * static_cast<long double>(rho_e) + rho);
      const long double exact = std::pow(k, 4.0L) * std::pow(a, 6.0L) / 9 * contrast * contrast;
      const double got = particleBackscatter(1.2e4, 2.75e-6, G_e, 4.09e-10, rho_e, 1021);
      EXPECT_NEAR(static_cast<double>(got / exact), 1, 1e-13);
    }
}

// Eq. 6: W (1-W)^4 is 0 at both ends. Packed cells do not scatter, for nothing varies any more.
TEST(BloodBackscatter, NoCellsAndNothingButCellsSendNothingBack) {
  EXPECT_EQ(bloodBackscatter(1e-16, 0, 1e-16), 0);
  EXPECT_EQ(bloodBackscatter(1e-16, 1, 1e-16), 0);
}

// d/dW of W (1-W)^4 / (1+2W)^2 is 0 where 1 - 7 W - 6 W^2 = 0.
TEST(BloodBackscatter, IsLargestAtTheRootOfItsDerivative) {
  const double best = (std::sqrt(73.0) - 7) / 12;
  EXPECT_NEAR(best, 0.1287, 5e-5);
  const double top = bloodBackscatter(1, best, 1);
  for (int i = 0; i <= 100000; ++i) {
    const double W = i / 100000.0;
    EXPECT_LE(bloodBackscatter(1, W, 1), top * (1 + 1e-15));
    EXPECT_GE(bloodBackscatter(1, W, 1), 0);
  }
  EXPECT_LT(bloodBackscatter(1, best - 1e-3, 1), top);
  EXPECT_LT(bloodBackscatter(1, best + 1e-3, 1), top);
}

// A number worked out by hand.
TEST(BloodBackscatter, IsEqSixAtAWorkedHematocrit) {
  EXPECT_NEAR(bloodBackscatter(3e-17, 0.45, 9e-17),
              3e-17 / 9e-17 * 0.45 * std::pow(0.55, 4) / (1.9 * 1.9), 1e-16);
}

long double closedBracket(long double x) {
  return std::atan(x) + std::atan(3 * x) / 9 - x / (1 + x * x) - x / (3 * (1 + 9 * x * x));
}

// The power series of the four terms of Eq. 7, added coefficient by coefficient.
long double seriesBracket(long double x) {
  long double sum = 0, power = x, threes = 3, nines = 1, sign = 1;
  for (int j = 0; j < 60; ++j) {
    const long double n = 2 * j + 1;
    sum += sign * power * (j == 0 ? 0 : 1 / n + threes / (9 * n) - 1 - nines / 3);
    power *= x * x;
    threes *= 9;
    nines *= 9;
    sign = -sign;
  }
  return sum;
}

long double exactTissue(long double mu, long double k, long double b_m) {
  const long double x = k * b_m;
  return 3 * mu * mu * k / (4 * kPi) * (x < 0.1L ? seriesBracket(x) : closedBracket(x));
}

// The oracle itself is tested: its series below x = 0.1 and its closed form above.
TEST(TissueBackscatter, TheOraclesTwoFormsMeet) {
  for (const long double x : {0.08L, 0.1L, 0.15L})
    EXPECT_NEAR(static_cast<double>(seriesBracket(x) / closedBracket(x)), 1, 1e-15);
  EXPECT_NEAR(static_cast<double>(seriesBracket(1e-9L) / (8.0L / 3 * 1e-27L)), 1, 1e-15);
}

// Over 15 decades. The bracket of Eq. 7 cancels to (8/3) x^3, so a plain double evaluation has no
// digit left at x = 1e-6.
TEST(TissueBackscatter, AgreesWithLongDoubleFromVanishingToHugeCorrelationLengths) {
  double worst = 0;
  for (int i = 0; i <= 15000; ++i) {
    const double b_m = std::pow(10.0, -9 + i / 1000.0) / 1e4;
    const double error = static_cast<double>(
        std::abs(tissueBackscatter(0.004, 1e4, b_m) / exactTissue(0.004, 1e4, b_m) - 1));
    EXPECT_LT(error, 1e-12) << "k b_m = " << 1e4 * b_m;
    worst = std::max(worst, error);
  }
  RecordProperty("worst_relative_error", std::to_string(worst));
  std::printf("Eq. 7 worst relative error %.2g\n", worst);
}

// The program's series and its closed form take turns at k b_m = 0.05.
TEST(TissueBackscatter, ClosesThePointWhereTheTwoFormsTakeTurns) {
  for (double x = 0.05 - 1e-12; x < 0.05 + 1e-12; x += 1e-13)
    EXPECT_NEAR(static_cast<double>(tissueBackscatter(1, 1, x) / exactTissue(1, 1, x)), 1, 1e-12);
}

// Eq. 7 with mu = 0 or b_m = 0 leaves nothing to scatter.
TEST(TissueBackscatter, VanishesWithoutCorrelationOrVariation) {
  EXPECT_EQ(tissueBackscatter(0.004, 1e4, 0), 0);
  EXPECT_EQ(tissueBackscatter(0, 1e4, 3e-5), 0);
}

// Every echo image shows blood at least 20 dB darker than the wall.
TEST(BuiltInMedia, BloodIsTwentyDecibelsBelowMyocardiumAtCardiacFrequencies) {
  for (const std::string mhz : {"2", "2.5", "3.5", "5"}) {
    support::SceneText text = support::SceneText::oneBox("blood");
    text.background = "myocardium";
    text.setProbe("frequency_mhz", mhz);
    const Scene scene = support::parsed(text);
    EXPECT_LT(decibelsFromIntensity(scene.media[1].backscatter_per_m_sr /
                                    scene.media[0].backscatter_per_m_sr),
              -20)
        << mhz << " MHz";
  }
}

}  // namespace
}  // namespace echocine
