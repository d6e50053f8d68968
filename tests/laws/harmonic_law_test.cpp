// Second-harmonic imaging and downshift against closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/units.h"
#include "scene/sampled_beam.h"
#include "signal/harmonic.h"
#include "signal/noise.h"
#include "signal/profile_average.h"
#include "support/plain_scene.h"
#include "support/speckle_bed.h"

namespace echocine::harmonic_law {
namespace {

using namespace support;

Probe probeOf(double aperture_m, double focus_m) {
  Probe probe = plainScene({medium("tissue", 1060, 1540, 15, 0.1)}).probe;
  probe.lines = 256;
  probe.samples = 400;
  probe.first_angle_rad = -0.6;
  probe.last_angle_rad = 0.6;
  probe.frequency_hz = 2.5e6;
  probe.min_depth_m = 2e-3;
  probe.max_depth_m = 0.16;
  probe.aperture_m = aperture_m;
  probe.focus_m = focus_m;
  return probe;
}

// Second way: the integral of 1/w.
TEST(HarmonicLaw, BuildsUpWithTheIntegralOfTheInverseWidth) {
  for (const double aperture_m : {0.012, 0.02, 0.03}) {
    const Probe probe = probeOf(aperture_m, 0.07);
    const double sent_m = 2 * 1540 / probe.frequency_hz;
    const auto sumTo = [&](double path_m) {
      constexpr int kSteps = 20000;
      double sum = 0;
      for (int i = 0; i < kSteps; ++i) {
        const double z = path_m * (i + 0.5) / kSteps;
        sum +=
            1 / std::hypot(1.27 * sent_m * 0.07 / aperture_m, 0.45 * aperture_m * (1 - z / 0.07));
      }
      return sum * path_m / kSteps;
    };
    for (const double path_m : {0.01, 0.03, 0.07, 0.15})
      EXPECT_NEAR(harmonicBuildUp(probe, path_m), std::pow(sumTo(path_m) / sumTo(0.07), 2), 1e-6);
  }
}

TEST(HarmonicLaw, OfAPlaneWaveGrowsWithTheSquareOfThePath) {
  const Probe probe = probeOf(1e-4, 0.07);
  for (const double path_m : {0.01, 0.035, 0.14})
    EXPECT_NEAR(harmonicBuildUp(probe, path_m), std::pow(path_m / 0.07, 2), 1e-5);
}

TEST(HarmonicLaw, GainEvensTheBuildUpFromTwelveDecibelsOn) {
  const Probe probe = probeOf(0.02, 0.07);
  const std::vector<float> built = buildUps(probe), gains = gainsOfBuildUp(probe);
  int dark = 0;
  for (std::size_t k = 0; k < built.size(); ++k) {
    const double even = static_cast<double>(built[k]) * static_cast<double>(gains[k]);
    if (built[k] < std::pow(10, -1.2f)) {
      ++dark;
      EXPECT_NEAR(even, std::pow(10, 1.2) * static_cast<double>(built[k]), 1e-6);
    } else {
      EXPECT_NEAR(even, 1, 1e-6);
    }
  }
  EXPECT_GT(dark, 20);
  EXPECT_LT(dark, 100);  // the first 4 cm at most
}

// Full width of P at a fraction of its peak, at the focus, by its integral's slope.
double widthOf(const SampledBeam& beam, double fraction) {
  const SampledBeam::Profile profile = beam.at(0);
  constexpr double kStep = 2e-4;
  const auto power = [&](double u) {
    return (profile.integral(u + kStep) - profile.integral(u - kStep)) / (2 * kStep);
  };
  double u = 0;
  while (power(u) > fraction * power(0)) u += 1e-4;
  return 2 * u;
}

// At the focus, with v = pi D u / lambda: sinc^4(v / 2) sinc^2(v) against sinc^4(v) of the
// fundamental received at the same frequency, and sinc^4(v / 2) of the one that was sent.
TEST(HarmonicLaw, BeamLiesBetweenThoseOfItsTwoFrequencies) {
  const Probe probe = probeOf(0.02, 0.07);
  constexpr double kLong = 40;  // cycles: one frequency
  const double lambda_m = 1540 / (0.963 * probe.frequency_hz);
  const auto sinc = [](double x) { return x == 0 ? 1 : std::sin(x) / x; };
  const auto closed = [&](auto power) {
    double v = 0;
    while (power(v) > 0.25) v += 1e-4;
    return 2 * v * lambda_m / (std::numbers::pi * probe.aperture_m);
  };
  const double harmonic = widthOf(SampledBeam(probe, kLong, true), 0.25),
               fundamental = widthOf(SampledBeam(probe, kLong), 0.25);
  EXPECT_NEAR(harmonic,
              closed([&](double v) { return std::pow(sinc(v / 2), 4) * std::pow(sinc(v), 2); }),
              0.03 * harmonic);
  EXPECT_NEAR(fundamental, closed([&](double v) { return std::pow(sinc(v), 4); }),
              0.03 * fundamental);
  Probe sent = probe;
  sent.frequency_hz /= 2;
  const double low = widthOf(SampledBeam(sent, kLong), 0.25);
  EXPECT_GT(harmonic, fundamental);
  EXPECT_LT(harmonic, 0.75 * low);
}

double outside(const SampledBeam& beam, double u) {
  return 1 - 2 * beam.at(0).integral(u);
}

// Energy beyond twice the first null, 2 lambda / D from the axis.
TEST(HarmonicLaw, HasWeakerSideLobes) {
  const Probe probe = probeOf(0.02, 0.07);
  const double u = 2 * 1540 / (probe.frequency_hz * probe.aperture_m);
  EXPECT_LT(outside(SampledBeam(probe, 2, true), 2 * u),
            0.5 * outside(SampledBeam(probe, 2), 2 * u));
}

TEST(HarmonicLaw, NearFieldClutterIsWeakerByTheBuildUp) {
  Scene scene = plainScene({medium("tissue", 1060, 1540, 15, 0.1)});
  scene.probe = probeOf(0.02, 0.07);
  const std::vector<float> plain = clutterLevels(scene), built = clutterLevels(scene, true);
  ASSERT_EQ(plain.size(), built.size());
  for (std::size_t k = 0; k < plain.size(); ++k) {
    const double path_m = 2e-3 + (static_cast<double>(k) + 0.5) * 0.158 / 400;
    const double even = std::min(1.0, std::pow(10, 1.2) * harmonicBuildUp(scene.probe, path_m));
    EXPECT_NEAR(static_cast<double>(built[k]), even * static_cast<double>(plain[k]),
                1e-5 * static_cast<double>(plain[k]));
  }
  EXPECT_LT(static_cast<double>(built.front()), 0.05 * static_cast<double>(plain.front()));
}

// Second way: the centre of a Gaussian spectrum times exp(-4 alpha f z).
TEST(DownshiftLaw, IsTheCentreOfTheAttenuatedSpectrum) {
  const Probe probe = probeOf(0.02, 0.07);
  constexpr double kAlpha = 4.72e-6;
  for (const double path_m : {0.03, 0.1, 0.16}) {
    const double sigma = spectrumDeviation(2, probe.bandwidth) * probe.frequency_hz;
    double sum = 0, moment = 0;
    for (double f = -1e6; f < 6e6; f += 500) {
      const double away = (f - probe.frequency_hz) / sigma;
      const double power = std::exp(-0.5 * away * away - 4 * kAlpha * f * path_m);
      sum += power;
      moment += power * f;
    }
    EXPECT_NEAR(downshiftOf(probe, 2, kAlpha, path_m), moment / sum / probe.frequency_hz, 1e-4);
  }
  EXPECT_EQ(downshiftOf(probe, 2, 0, 0.16), 1);
}

// A bright line spreads as with a probe of the lower frequency and the same bandwidth in Hz.
TEST(DownshiftLaw, WidensTheBeamAsALowerFrequencyDoes) {
  const Probe probe = probeOf(0.02, 0.07);
  constexpr double kAlpha = 7e-6;
  const double path_m = 0.14;
  const double factor = downshiftOf(probe, 2, kAlpha, path_m);
  ASSERT_LT(factor, 0.85);
  Probe lower = probe;
  lower.frequency_hz *= factor;
  lower.bandwidth /= factor;
  const auto spreadOf = [&](const Probe& of, const BeamPulse& pulse) {
    std::vector<float> plane(std::size_t{256} * 400);
    const int sample = static_cast<int>((path_m - of.min_depth_m) / of.sampleSpacing());
    plane[std::size_t{128} * 400 + static_cast<std::size_t>(sample)] = 1;
    ProfileAverage(of, pulse).apply(plane, {0, 256});
    double sum = 0, squares = 0;
    for (int i = 108; i < 149; ++i) {
      const double power = static_cast<double>(
          plane[static_cast<std::size_t>(i) * 400 + static_cast<std::size_t>(sample)]);
      sum += power;
      squares += power * (i - 128) * (i - 128);
    }
    return std::sqrt(squares / sum);
  };
  const double shifted = spreadOf(probe, {2, false, kAlpha}), plain = spreadOf(probe, 2),
               low = spreadOf(lower, 2 * factor);
  EXPECT_GT(shifted, 1.05 * plain);
  EXPECT_NEAR(shifted, low, 0.04 * low);
}

// Widths of speckle's intensity correlation, in samples and in lines, about a depth: the mean over
// seeds.
std::pair<double, double> cellOf(const SpeckleBed& bed, const PointSpread& spread, double path_m) {
  std::vector<double> along(10), across(10);
  const int k = static_cast<int>((path_m - bed.probe.min_depth_m) / bed.probe.sampleSpacing());
  const Window window{0, bed.probe.lines - 10, k - 60, k + 60};
  SpeckleSettings settings = bed.settings;
  for (settings.seed = 1; settings.seed <= 6; ++settings.seed) {
    const std::vector<float> picture =
        bed.picture(Speckle(bed.probe, spread, settings, bed.material));
    for (int lag = 0; lag < 10; ++lag) {
      const auto at = static_cast<std::size_t>(lag);
      along[at] += correlation(picture, picture, bed.probe.samples, window, 0, lag) / 6;
      across[at] += correlation(picture, picture, bed.probe.samples, window, lag, 0) / 6;
    }
  }
  return {widthAtHalf(along), widthAtHalf(across)};
}

// Cells of the same scatterers with and without downshift, next to the inverse of the closed form.
TEST(DownshiftLaw, WidensSpeckleCellsBothWaysAsTheWavelengthGrows) {
  SpeckleBed bed(ProbeKind::phased, 128, 1000, 0.01, 0.16);
  bed.material.reach_m = 0.003;
  Scene scene = plainScene({medium("tissue", 1060, 1540, 15, 0.1)});
  scene.probe = bed.probe;
  scene.signal.beam_width = BeamWidth::profile;
  const PointSpread plain(scene);
  scene.signal.downshift = true;
  scene.signal.nominal_gain_np_per_m_hz = 7e-6;
  const PointSpread shifted(scene);
  for (const double path_m : {0.03, 0.14}) {
    const double sigma_hz = spectrumDeviation(2, bed.probe.bandwidth) * bed.probe.frequency_hz;
    const double wider = 1 / (1 - 4 * 7e-6 * path_m * sigma_hz * sigma_hz / bed.probe.frequency_hz);
    const auto [axial, lateral] = cellOf(bed, plain, path_m);
    const auto [axial_shifted, lateral_shifted] = cellOf(bed, shifted, path_m);
    EXPECT_NEAR(axial_shifted / axial, wider, 0.02 * wider) << path_m;
    EXPECT_NEAR(lateral_shifted / lateral, wider, 0.02 * wider) << path_m;
  }
}

}  // namespace
}  // namespace echocine::harmonic_law
