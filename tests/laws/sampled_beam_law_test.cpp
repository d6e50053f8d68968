// The sampled two-way beam, against sums over elements and the widths of an array simulator.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <vector>

#include "core/parallel.h"
#include "core/units.h"
#include "scene/sampled_beam.h"
#include "scene/scan_geometry.h"
#include "signal/profile_average.h"
#include "support/array_probe.h"

namespace echocine {
namespace {

using support::arrayProbe;

constexpr double kCycles = 2;

// Energy of a point's echo by u: exact distances, the pulse's spectrum at 13 frequencies.
class ElementSum {
 public:
  ElementSum(const Probe& probe, double path_m, double angle_rad) {
    constexpr int kElements = 97;
    constexpr double c = kScannerSpeed;
    for (int n = 0; n < kElements; ++n) {
      const double place = (2 * n + 1.0) / kElements - 1;
      places_.push_back(place * static_cast<double>(probe.aperture_m) / 2);
      const double bell = (1 + std::cos(std::numbers::pi * place)) / 2;
      weights_.push_back(probe.receive_apodization == Apodization::hann      ? bell
                         : probe.receive_apodization == Apodization::hamming ? 0.08 + 0.92 * bell
                                                                             : 1.0);
    }
    const double f = probe.frequency_hz;
    // Deviations of the amplitude spectra of 2 cycles and of the bandwidth, from -6 dB widths.
    const double pulse = 1.2067 * f / kCycles / 2.3548, band = 0.74 * f / 2.3548;
    const double deviation = pulse * band / std::hypot(pulse, band);
    for (int i = -6; i <= 6; ++i) {
      const double away = i / 2.0;
      numbers_.push_back(2 * std::numbers::pi * (0.963 * f + away * deviation / std::sqrt(2.0)) /
                         c);
      powers_.push_back(std::exp(-away * away / 2));
    }
    const double s = std::sin(angle_rad), k = std::cos(angle_rad);
    for (const double x : places_) {
      transmit_.push_back(std::hypot(probe.focus_m * s - x, probe.focus_m * k));
      receive_.push_back(std::hypot(path_m * s - x, path_m * k));
    }
    path_ = path_m;
    sine_ = s;
    peak_ = energy(0);
  }

  double at(double u) const { return static_cast<double>(energy(u) / peak_); }

 private:
  double energy(double u) const {
    const double s = sine_ + u;
    if (std::abs(s) >= 1) return 0;
    const double x0 = path_ * s, z0 = path_ * std::sqrt(1 - s * s);
    double sum = 0;
    for (std::size_t f = 0; f < numbers_.size(); ++f) {
      std::complex<double> sent = 0, heard = 0;
      for (std::size_t n = 0; n < places_.size(); ++n) {
        const double to = std::hypot(x0 - places_[n], z0);
        sent += std::polar(1.0, numbers_[f] * (to - transmit_[n]));
        heard += std::polar(weights_[n], numbers_[f] * (to - receive_[n]));
      }
      sum += powers_[f] * std::norm(sent) * std::norm(heard);
    }
    return sum;
  }

  std::vector<double> places_, weights_, numbers_, powers_, transmit_, receive_;
  double path_ = 0, sine_ = 0, peak_ = 1;
};

// Full width at a level (dB) of a profile by u, at its first fall on both sides.
double widthOf(const std::function<double(double)>& profile, double level_db) {
  const double level = std::pow(10, level_db / 10) * profile(0);
  double width = 0;
  for (const double side : {-1.0, 1.0}) {
    double low = 0, high = 0;
    while (profile(side * high) > level && high < 0.5) low = std::exchange(high, high + 1e-3);
    for (int i = 0; i < 12; ++i) {
      const double middle = 0.5 * (low + high);
      (profile(side * middle) > level ? low : high) = middle;
    }
    width += low;
  }
  return width;
}

std::function<double(double)> sampled(const SampledBeam& beam, double path_m, double angle_rad) {
  const auto profile = beam.at(beam.defocus(path_m, std::sin(angle_rad)));
  return [profile](double u) {
    return (profile.integral(u + 2e-4) - profile.integral(u - 2e-4)) / 4e-4;
  };
}

// Law: main lobe and first side lobes are those of the array, steered, defocused and apodized.
TEST(SampledBeamLaw, WidthsAreThoseOfASumOverTheElements) {
  double worst6 = 0, worst20 = 0;
  for (const double aperture_mm : {12.0, 19.2, 24.0})
    for (const double focus_mm : {50.0, 80.0, 120.0})
      for (const Apodization receive :
           {Apodization::uniform, Apodization::hann, Apodization::hamming}) {
        Probe probe = arrayProbe();
        probe.aperture_m = metresFromMillimetres(aperture_mm);
        probe.focus_m = metresFromMillimetres(focus_mm);
        probe.receive_apodization = receive;
        const SampledBeam beam(probe, kCycles);
        for (const double depth_mm : {30.0, 80.0, 140.0})
          for (const double degrees : {0.0, 25.0, 38.0}) {
            const double z = metresFromMillimetres(depth_mm), a = radiansFromDegrees(degrees);
            const ElementSum elements(probe, z, a);
            const auto exact = [&](double u) { return elements.at(u); };
            const auto ours = sampled(beam, z, a);
            const bool own = probe.aperture_m == arrayProbe().aperture_m &&
                             probe.focus_m == arrayProbe().focus_m &&
                             receive == Apodization::uniform;
            const double six = widthOf(ours, -6) / widthOf(exact, -6) - 1;
            worst6 = std::max(worst6, std::abs(six));
            // The cubic phase of a steered, defocused aperture is left out; it counts most nearby.
            EXPECT_NEAR(six, 0,
                        own        ? 0.1
                        : z < 0.04 ? 0.25
                                   : 0.15)
                << aperture_mm << " " << focus_mm << " " << depth_mm << " " << degrees << " "
                << static_cast<int>(receive);
            // Where it falls steeply, a width; on a shoulder, a level.
            const double twenty = widthOf(exact, -20);
            const double level = 10 * std::log10(ours(0.5 * twenty) / ours(0)) + 20;
            const double ratio = widthOf(ours, -20) / twenty - 1;
            worst20 = std::max(worst20, std::min(std::abs(ratio), std::abs(level) / 20));
            EXPECT_TRUE(std::abs(ratio) < 0.2 || std::abs(level) < 4)
                << ratio << " " << level << " dB; " << aperture_mm << " " << focus_mm << " "
                << depth_mm << " " << degrees << " " << static_cast<int>(receive);
          }
      }
  std::printf("worst widths: %.3f at -6 dB, %.3f at -20 dB\n", worst6, worst20);
}

// SIMUS (Garcia 2022): 64 elements, transmit focus 8 cm; mm at 3, 5, 8, 11, 14 cm. Its -20 dB at 5
// cm ends before a shoulder, which in energy stays over -20 dB; the level there is compared.
TEST(SampledBeamLaw, WidthsAreThoseOfALinearArraySimulator) {
  const double depths_m[] = {0.03, 0.05, 0.08, 0.11, 0.14};
  const double six[] = {1.14, 1.81, 2.14, 3.09, 4.29}, steered[] = {1.23, 1.80, 2.35, 3.35, 4.51};
  const double twenty[] = {3.47, 3.25, 3.82, 5.54, 7.56};
  const SampledBeam beam(arrayProbe(), kCycles);
  const double angle = radiansFromDegrees(25);
  for (std::size_t i = 0; i < 5; ++i) {
    const double z = depths_m[i], mm = millimetresFromMetres(z);
    const auto straight = sampled(beam, z, 0);
    EXPECT_NEAR(widthOf(straight, -6) * mm / six[i], 1, 0.04) << mm;
    EXPECT_NEAR(widthOf(sampled(beam, z, angle), -6) * mm / std::cos(angle) / steered[i], 1, 0.1);
    if (i == 1)
      EXPECT_NEAR(10 * std::log10(straight(0.5 * twenty[i] / mm) / straight(0)), -20, 2);
    else
      EXPECT_NEAR(widthOf(straight, -20) * mm / twenty[i], 1, 0.15) << mm;
  }
}

std::vector<float> constant(const Probe& probe) {
  return std::vector<float>(static_cast<std::size_t>(probe.lines * probe.samples), 1.0f);
}

// Law: the average of a constant is that constant, for any kind and any count of lines.
TEST(SampledBeamLaw, AConstantPlaneStaysConstant) {
  for (const ProbeKind kind : {ProbeKind::phased, ProbeKind::curvilinear, ProbeKind::linear})
    for (const int lines : {2, 3, 96, 300, 513, 1100}) {
      Probe probe = arrayProbe();
      probe.kind = kind;
      probe.lines = lines;
      probe.samples = 203;
      if (kind == ProbeKind::curvilinear) probe.face_radius_m = 0.06;
      if (kind == ProbeKind::linear) {
        probe.first_angle_rad = probe.last_angle_rad = 0;
        probe.first_offset_m = -0.02;
        probe.last_offset_m = 0.02;
      }
      std::vector<float> plane = constant(probe);
      ProfileAverage(probe, kCycles).apply(plane, {0, lines});
      for (const float value : plane) ASSERT_NEAR(value, 1, 1e-5) << lines;
    }
}

// Law: what lines show of a bright point is the beam, also between rows of many lines.
TEST(SampledBeamLaw, ABrightLineShowsTheBeam) {
  for (const int lines : {181, 361, 1443}) {
    Probe probe = arrayProbe();
    probe.lines = lines;
    probe.samples = 140;
    const ProfileAverage average(probe, kCycles);
    const ScanGeometry geometry(probe);
    for (const double degrees : {0.0, 25.0, -38.0}) {
      const int bright = static_cast<int>(std::lround(
          (radiansFromDegrees(degrees) - geometry.firstPlace()) / geometry.cellWidth()));
      std::vector<float> plane(static_cast<std::size_t>(lines * probe.samples), 0.0f);
      std::fill_n(plane.begin() + std::ptrdiff_t{bright} * probe.samples, probe.samples, 1.0f);
      average.apply(plane, {0, lines});
      for (const int k : {20, 60, 120}) {
        const double z = geometry.sampleDepth(k),
                     s = std::sin(lineGeometry(probe, bright).direction.x == 0
                                      ? 0
                                      : geometry.firstPlace() + bright * geometry.cellWidth());
        const auto shown = [&](double u) {
          const double place = (std::asin(s + u) - geometry.firstPlace()) / geometry.cellWidth();
          const int line = static_cast<int>(place);
          const auto of = [&](int i) {
            return static_cast<double>(plane[static_cast<std::size_t>(i * probe.samples + k)]);
          };
          return of(line) + (place - line) * (of(line + 1) - of(line));
        };
        const ElementSum elements(probe, z, std::asin(s));
        const auto exact = [&](double u) { return elements.at(u); };
        EXPECT_NEAR(widthOf(shown, -6) / widthOf(exact, -6), 1, 0.1) << lines << " " << degrees;
      }
    }
  }
}

// Law: a dark disc has the floor that the array's side lobes leave.
TEST(SampledBeamLaw, ACystHasTheFloorOfItsSideLobes) {
  for (const Apodization receive : {Apodization::uniform, Apodization::hann})
    for (const double depth_m : {0.05, 0.10}) {
      Probe probe = arrayProbe();
      probe.receive_apodization = receive;
      const ScanGeometry geometry(probe);
      std::vector<float> plane = constant(probe);
      const auto dark = [&](int line, int sample, double radius_m) {
        const LineGeometry at = lineGeometry(probe, line);
        const Vec3d p = at.origin + geometry.sampleDepth(sample) * at.direction;
        return std::hypot(p.x, p.z - depth_m) < radius_m;
      };
      for (int i = 0; i < probe.lines; ++i)
        for (int k = 0; k < probe.samples; ++k)
          if (dark(i, k, 7.5e-3)) plane[static_cast<std::size_t>(i * probe.samples + k)] = 0;
      ProfileAverage(probe, kCycles).apply(plane, {0, probe.lines});
      const int line = probe.lines / 2;
      const auto sample = static_cast<int>((depth_m - probe.min_depth_m) / probe.sampleSpacing());
      const double z = geometry.sampleDepth(sample);
      const ElementSum elements(probe, z, 0);
      double outside = 0, all = 0;
      for (int j = 0; j < probe.lines; ++j) {
        const double angle = geometry.firstPlace() + j * geometry.cellWidth();
        const double power = elements.at(std::sin(angle)) * std::cos(angle);
        all += power;
        if (!dark(j, sample, 7.5e-3)) outside += power;
      }
      const double expected_db = 10 * std::log10(outside / all);
      const double floor_db =
          10 * std::log10(plane[static_cast<std::size_t>(line * probe.samples + sample)]);
      std::printf("floor %.1f dB, elements %.1f dB\n", floor_db, expected_db);
      EXPECT_NEAR(floor_db, expected_db, receive == Apodization::uniform ? 1 : 3);
      EXPECT_LT(floor_db, -20);
    }
}

TEST(SampledBeamLaw, SomeLinesAreThoseOfTheWhole) {
  Probe probe = arrayProbe();
  std::vector<float> whole(static_cast<std::size_t>(probe.lines * probe.samples));
  for (std::size_t i = 0; i < whole.size(); ++i) whole[i] = static_cast<float>(i * 7919 % 1009);
  const ProfileAverage average(probe, kCycles);
  std::vector<float> some = whole;
  average.apply(some, {100, 140});
  withThreads(1, [&] { average.apply(whole, {0, probe.lines}); });
  for (int i = 100; i < 140; ++i)
    for (int k = 0; k < probe.samples; ++k) {
      const auto at = static_cast<std::size_t>(i * probe.samples + k);
      ASSERT_EQ(some[at], whole[at]);
    }
}

// SIMUS (Garcia 2022): lateral speckle cells at the focus, 2.05 mm and with Hann receive 2.37 mm.
TEST(SampledBeamLaw, ApodizationWidensSpeckleAsInASimulator) {
  EXPECT_EQ(speckleWidening(Apodization::uniform), 1);
  EXPECT_NEAR(speckleWidening(Apodization::hann), 2.37 / 2.05, 0.08);
}

// With a uniform receiving aperture from -1 to 1, H is 2 - x over 0 <= x <= 2 for the fundamental;
// the harmonic's is 1 - x^2 / 2 up to 1 and (2 - x)^2 / 2 beyond. The variances of H^2 are 2/5 and
// 50/161.
TEST(SampledBeamLaw, TheHarmonicWidensSpeckle) {
  EXPECT_NEAR(speckleWidening(Apodization::uniform, true), std::sqrt(0.4 * 161 / 50), 1e-3);
  EXPECT_GT(speckleWidening(Apodization::hann, true), speckleWidening(Apodization::hann));
}

}  // namespace
}  // namespace echocine
