// Phases of a membrane's scatterers: each has that of its own place, whatever its neighbours' are.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "scene/beam_profile.h"
#include "speckle/splat.h"
#include "support/speckle_bed.h"

namespace echocine {
namespace {

using namespace support;

constexpr int kSheetLines = 8, kSheetSamples = 4000;

// Echoes of eight scatterers, one to a line, at these samples and this part of the cut across.
std::array<std::complex<double>, 8> echoesAt(const Probe& probe, const PointSpread& spread,
                                             Floats8 sample, float across) {
  const std::vector<float> ones(16, 1.0f), zeros(16, 0.0f);
  const GaussianMix mix{ones.data(), zeros.data(), ones.data(), zeros.data()};
  SplatLists lists;
  lists.start(kSheetLines, {0, kSheetLines});
  const Floats8 line{0.5f, 1.5f, 2.5f, 3.5f, 4.5f, 5.5f, 6.5f, 7.5f};
  Splatter(probe, spread).addPlaces({line, sample, Floats8{} + across}, mix, 0, lists);
  lists.settle();
  std::array<std::complex<double>, 8> echoes;
  for (int i = 0; i < kSheetLines; ++i) {
    EXPECT_EQ(lists.line(i).size(), 1u);
    if (lists.line(i).empty()) continue;
    const Splat& splat = lists.line(i).front();
    echoes[static_cast<std::size_t>(i)] = {static_cast<double>(splat.real),
                                           static_cast<double>(splat.imaginary)};
  }
  return echoes;
}

// A sheet that runs along the beam from 2 to 15 cm: its scatterers in one group of eight and each
// with seven at its own depth. In the closed form the curved wave of the lens adds b y^2 / 2.
TEST(SheetPhase, DoesNotDependOnTheGroupsOtherPlaces) {
  const Probe probe = speckleProbe(ProbeKind::phased, kSheetLines, kSheetSamples, 0.01, 0.16);
  const PointSpread spread(probe, 2);
  const Floats8 along{300, 700, 1100, 1500, 2000, 2500, 3000, 3700};
  for (const float across : {0.3f, 0.8f}) {
    const auto together = echoesAt(probe, spread, along, across);
    for (std::size_t i = 0; i < 8; ++i) {
      const float sample = along[static_cast<int>(i)];
      const auto alone = echoesAt(probe, spread, Floats8{} + sample, across);
      EXPECT_NEAR(std::abs(together[i] - alone[i]), 0, 1e-5) << sample;
      const double z = probe.min_depth_m + static_cast<double>(sample) * probe.sampleSpacing();
      const double to_deviation = 1 / std::sqrt(8 * std::log(2.0));
      const double s0 = followedWidth(z, spread.aperture_m, spread.wavelength_m) / std::sqrt(2.0) *
                        to_deviation,
                   sa = spread.elevationWidth(z) * to_deviation;
      const double y = static_cast<double>(across) * kElevationCut * spread.elevationWidth(z);
      const double b = std::sqrt(std::max(0.0, 1 / (s0 * s0) - 1 / (sa * sa))) / sa;
      const double focusing = z < spread.focus_m ? 1 : -1;
      const double turns =
          2 * z / spread.wavelength_m + focusing * b * y * y / 2 / (2 * std::numbers::pi);
      const std::complex<double> exact = std::polar(1.0, -2 * std::numbers::pi * turns);
      EXPECT_NEAR(std::abs(alone[i] / std::abs(alone[i]) - exact), 0, 0.02) << sample;
    }
  }
}

}  // namespace
}  // namespace echocine
