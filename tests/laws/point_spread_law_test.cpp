// The extent of one scatterer's echo, against the definitions of its widths.

#include "speckle/point_spread.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/plain_scene.h"

namespace echocine {
namespace {

using namespace support;

TEST(PointSpreadLaw, ABellIsAGaussianOfItsDeviation) {
  for (const double deviation : {1e-4, 1.0, 30.0}) {
    EXPECT_EQ(bell(0, deviation), 1);
    EXPECT_NEAR(bell(deviation, deviation), std::exp(-0.5), 1e-12);
    EXPECT_NEAR(bell(-2 * deviation, deviation), std::exp(-2.0), 1e-12);
    EXPECT_NEAR(bell(kWidthAtHalf / 2 * deviation, deviation), 0.5, 1e-12);
  }
  EXPECT_EQ(bell(0, 0), 1);
  EXPECT_EQ(bell(1e-300, 0), 0);
}

// At half the full width the intensity is down by 6 dB, a quarter, and the amplitude is a half.
TEST(PointSpreadLaw, WidthsAreThoseAtMinusSixDecibels) {
  Probe probe = plainScene({medium("plain", 1000, 1540)}).probe;
  probe.frequency_hz = 2.5e6;
  const PointSpread spread(probe, 2);
  EXPECT_NEAR(spread.axial_width_m, 0.55e-3, 0.01e-3);
  EXPECT_NEAR(PointSpread(probe, 4).axial_width_m, 2 * spread.axial_width_m, 1e-15);
  EXPECT_NEAR(bell(spread.axial_width_m / 2, spread.axial_m), 0.5, 1e-3);
  for (const double path_m : {0.02, 0.1}) {
    EXPECT_NEAR(bell(spread.lateralWidth(path_m) / 2, spread.angle_rad * path_m), 0.5, 1e-3);
    EXPECT_NEAR(spread.angle_rad, 0.3625 * spread.wavelength_m / probe.aperture_m,
                1e-3 * spread.angle_rad);
  }
}

}  // namespace
}  // namespace echocine
