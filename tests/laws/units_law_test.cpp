// Conversions of units against their definitions, and there and back.

#include "core/units.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "video/video_builder.h"

namespace echocine {
namespace {

TEST(UnitsLaw, AnglesAndLengths) {
  EXPECT_DOUBLE_EQ(radiansFromDegrees(180), std::numbers::pi);
  EXPECT_DOUBLE_EQ(degreesFromRadians(radiansFromDegrees(37.5)), 37.5);
  EXPECT_DOUBLE_EQ(millimetresFromMetres(metresFromMillimetres(7.25)), 7.25);
  EXPECT_DOUBLE_EQ(metresFromMicrometres(1e6), 1);
  EXPECT_DOUBLE_EQ(millilitresFromCubicMetres(cubicMetresFromCubicCentimetres(120)), 120);
  EXPECT_DOUBLE_EQ(perCentimetreFromPerMetre(perMetreFromPerCentimetre(3)), 3);
  EXPECT_DOUBLE_EQ(hertzFromBeatsPerMinute(90), 1.5);
  EXPECT_DOUBLE_EQ(hertzFromMegahertz(2.5), 2.5e6);
  EXPECT_DOUBLE_EQ(perPascalFromSquareCentimetrePerDyne(1e-11), 1e-10);
}

// An amplitude that falls by one neper falls to 1/e, by 20 dB to a tenth; its intensity falls by
// the same decibels.
TEST(UnitsLaw, NepersAndDecibels) {
  EXPECT_DOUBLE_EQ(std::exp(-nepersFromDecibels(20)), 0.1);
  EXPECT_DOUBLE_EQ(decibelsFromNepers(1), 20 * std::log10(std::numbers::e));
  EXPECT_DOUBLE_EQ(decibelsFromNepers(nepersFromDecibels(-13)), -13);
  EXPECT_DOUBLE_EQ(decibelsFromIntensity(1e-3), -30);
  EXPECT_DOUBLE_EQ(intensityFromDecibels(-30), 1e-3);
  const double fall = std::exp(-nepersFromDecibels(6));
  EXPECT_NEAR(decibelsFromIntensity(fall * fall), -6, 1e-12);
  // 0.5 dB/(cm MHz^1.1) at 3 MHz.
  EXPECT_DOUBLE_EQ(nepersPerMetre(0.5, 1.1, 3e6),
                   100 * 0.5 * std::pow(3.0, 1.1) * std::numbers::ln10 / 20);
}

// Rec. 601: 0.299 red, 0.587 green, 0.114 blue, within a grey level; greys stay.
TEST(UnitsLaw, LumaIsThatOfRec601) {
  for (const int grey : {0, 1, 77, 128, 255}) EXPECT_EQ(lumaOf(grey, grey, grey), grey);
  EXPECT_NEAR(lumaOf(255, 0, 0), 0.299 * 255, 1);
  EXPECT_NEAR(lumaOf(0, 255, 0), 0.587 * 255, 1);
  EXPECT_NEAR(lumaOf(0, 0, 255), 0.114 * 255, 1);
}

}  // namespace
}  // namespace echocine
