// The receiving aperture that grows with depth: cells of speckle and beams against sums over
// elements.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <vector>

#include "scene/sampled_beam.h"
#include "signal/noise.h"
#include "signal/profile_average.h"
#include "speckle/beam_view.h"
#include "support/array_probe.h"
#include "support/plain_scene.h"
#include "support/speckle_bed.h"

namespace echocine::receive_aperture_law {
namespace {

using namespace support;

constexpr double kFNumber = 1.5;
using Pupil = std::vector<std::complex<double>>;

Pupil convolved(const Pupil& a, const Pupil& b) {
  Pupil out(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) out[i + j] += a[i] * b[j];
  return out;
}

// Places of elements from -1/2 to 1/2 of the aperture.
double placeOf(int n, int elements) {
  return (n + 0.5) / elements - 0.5;
}

Pupil sentPupil(int elements, double edge_phase) {
  Pupil out;
  for (int n = 0; n < elements; ++n)
    out.push_back(std::polar(1.0, -4 * edge_phase * std::pow(placeOf(n, elements), 2)));
  return out;
}

// Angle at which the intensity of speckle correlates by one half: the transform of |H|^2 (van
// Cittert, Zernike), H the convolution of the sent aperture with its defocus and the part that
// receives. The second harmonic is the square of a wave of half the frequency.
double cellWidth(const Probe& probe, bool harmonic, double part, double path_m) {
  constexpr int kElements = 256;
  const double half_m = probe.aperture_m / 2, k = 2 * std::numbers::pi * probe.frequency_hz / 1540;
  const double edge_phase = k / 2 * half_m * half_m * (1 / path_m - 1 / probe.focus_m);
  Pupil receiving;
  for (int n = 0; n < std::lround(kElements * part); ++n) receiving.emplace_back(1);
  const Pupil half = sentPupil(kElements / 2, edge_phase / 2);
  const Pupil both =
      convolved(harmonic ? convolved(half, half) : sentPupil(kElements, edge_phase), receiving);
  const double middle = 0.5 * static_cast<double>(both.size() - 1);
  const auto correlation = [&](double angle_rad) {
    double c = 0, sum = 0;
    for (std::size_t i = 0; i < both.size(); ++i) {
      const double place_m = (static_cast<double>(i) - middle) * probe.aperture_m / kElements;
      c += std::norm(both[i]) * std::cos(k * angle_rad * place_m);
      sum += std::norm(both[i]);
    }
    return c * c / (sum * sum);
  };
  double angle_rad = 0;
  while (correlation(angle_rad) > 0.5) angle_rad += 1e-5;
  return angle_rad;
}

TEST(ReceiveApertureLaw, IsDepthOverFNumberUpToTheWholeAndAtLeastAQuarter) {
  Probe probe = arrayProbe();
  probe.aperture_m = 0.02;
  EXPECT_EQ(receivingPart(probe, 0, 1e-3), 1);
  EXPECT_EQ(receivingPart(probe, kFNumber, 0), 0.25);
  EXPECT_EQ(receivingPart(probe, kFNumber, 7e-3), 0.25);
  EXPECT_NEAR(receivingPart(probe, kFNumber, 0.015), 0.5, 1e-12);
  EXPECT_EQ(receivingPart(probe, kFNumber, 0.03), 1);
  EXPECT_EQ(receivingPart(probe, kFNumber, 0.2), 1);
}

// Second way: the cells of both apertures, over those of the whole at the focus.
TEST(ReceiveApertureLaw, CellsAreThoseOfBothAperturesWithDefocus) {
  Probe probe = arrayProbe();
  probe.aperture_m = 0.02;
  probe.focus_m = 0.08;
  for (const bool harmonic : {false, true}) {
    const double at_focus = cellWidth(probe, harmonic, 1, probe.focus_m);
    for (const double path_m : {0.01, 0.015, 0.02, 0.03, 0.05, 0.08, 0.14}) {
      const double part = receivingPart(probe, kFNumber, path_m);
      const double cell = part * cellWidth(probe, harmonic, part, path_m) / at_focus;
      EXPECT_GT(cell, harmonic ? 0.73 : 0.98) << path_m;
      EXPECT_LT(cell, 1.08) << path_m;
    }
  }
}

// Half width at -6 dB of a profile by u.
double widthOf(const std::function<double(double)>& profile) {
  double u = 0;
  while (profile(u) > 0.25 * profile(0)) u += 1e-4;
  return u;
}

// Second way: a sum over the elements that send and those that receive, at the centre frequency.
TEST(ReceiveApertureLaw, BeamsNearTheFaceAreThoseOfTheElementsThatReceive) {
  Probe probe = arrayProbe();
  probe.aperture_m = 0.02;
  probe.min_depth_m = 0.002;
  probe.focus_m = 0.08;
  const double k = 2 * std::numbers::pi * probe.frequency_hz / 1540;
  const SampledBeam beam(probe, 20);
  for (const double path_m : {0.01, 0.015, 0.02, 0.025, 0.03, 0.05}) {
    const double part = receivingPart(probe, kFNumber, path_m);
    const auto summed = [&](double u) {
      constexpr int kElements = 200;
      std::complex<double> sent = 0, heard = 0;
      for (int n = 0; n < kElements; ++n) {
        const double x = placeOf(n, kElements) * probe.aperture_m;
        const double phase = k * (u * x - x * x * (1 / path_m - 1 / probe.focus_m) / 2);
        sent += std::polar(1.0, phase);
        heard += std::polar(1.0, k * u * x * part);
      }
      return std::norm(sent) * std::norm(heard);
    };
    const auto profile = beam.at(beam.defocus(path_m, 0));
    const auto scaled = [&](double u) {
      return profile.integral(part * u + 1e-4) - profile.integral(part * u - 1e-4);
    };
    EXPECT_NEAR(widthOf(scaled) / widthOf(summed), 1, 0.16) << path_m;
  }
}

// A bright point in muscle, before and after the average over the beam.
TEST(ReceiveApertureLaw, WidensTheAverageNearTheFaceOnly) {
  Probe probe = arrayProbe();
  probe.aperture_m = 0.02;
  probe.lines = 256;
  probe.samples = 400;
  probe.min_depth_m = 0.002;
  probe.max_depth_m = 0.16;
  const auto peakOf = [&](double f_number, double path_m) {
    std::vector<float> plane(std::size_t{256} * 400);
    const auto at = std::size_t{128} * 400 +
                    static_cast<std::size_t>((path_m - probe.min_depth_m) / probe.sampleSpacing());
    plane[at] = 1;
    ProfileAverage(probe, {2, false, 0, f_number}).apply(plane, {0, 256});
    return static_cast<double>(plane[at]);
  };
  EXPECT_NEAR(peakOf(kFNumber, 0.012) / peakOf(0, 0.012), 0.4, 0.06);
  EXPECT_NEAR(peakOf(kFNumber, 0.02) / peakOf(0, 0.02), 0.667, 0.06);
  EXPECT_EQ(peakOf(kFNumber, 0.1), peakOf(0, 0.1));
}

// Lines of the grain follow the part that receives, for all kinds of probes.
TEST(ReceiveApertureLaw, GrainFollowsThePartThatReceives) {
  for (const ProbeKind kind : {ProbeKind::phased, ProbeKind::curvilinear, ProbeKind::linear}) {
    const SpeckleBed bed(kind, 128, 400, 0.003, 0.1);
    Scene scene = plainScene({medium("tissue", 1060, 1540, 15, 0.1)});
    scene.probe = bed.probe;
    scene.signal.beam_width = BeamWidth::profile;
    const PointSpread whole(scene);
    scene.signal.receive_f_number = kFNumber;
    const PointSpread growing(scene);
    for (const double path_m : {0.004, 0.01, 0.02, 0.05, 0.09})
      EXPECT_NEAR(BeamView(bed.probe, growing).lateralLines(path_m) *
                      receivingPart(bed.probe, kFNumber, path_m),
                  BeamView(bed.probe, whole).lateralLines(path_m), 1e-9)
          << path_m;
    scene.signal.beam_width = BeamWidth::focused;
    EXPECT_EQ(PointSpread(scene).angle(0.01), PointSpread(scene).angle_rad);
  }
}

// Correlation of the intensity of clutter between lines `apart`, at a sample, and its mean.
std::pair<double, double> clutterAt(const Scene& scene, double path_m, int apart) {
  const auto k =
      static_cast<std::size_t>((path_m - scene.probe.min_depth_m) / scene.probe.sampleSpacing());
  double sum = 0, squares = 0, products = 0, n = 0;
  Scene seeded = scene;
  for (seeded.artefacts.clutter_seed = 1; seeded.artefacts.clutter_seed <= 40;
       ++seeded.artefacts.clutter_seed) {
    const NearFieldClutter clutter(seeded);
    std::vector<double> powers;
    for (int i = 0; i < scene.probe.lines; ++i) {
      std::vector<float> re(static_cast<std::size_t>(scene.probe.samples)), im(re.size());
      clutter.add(1, 0.07, i, re.data(), im.data());
      powers.push_back(static_cast<double>(re[k] * re[k] + im[k] * im[k]));
    }
    for (std::size_t i = 0; i + static_cast<std::size_t>(apart) < powers.size(); ++i) {
      const double p = powers[i], q = powers[i + static_cast<std::size_t>(apart)];
      sum += p, squares += p * p, products += p * q, n += 1;
    }
  }
  const double mean = sum / n;
  return {(products / n - mean * mean) / (squares / n - mean * mean), mean};
}

// The intensity of a complex Gaussian field correlates by exp(-d^2 / 2 s^2) at d lines.
TEST(ReceiveApertureLaw, ClutterOfAPhasedProbeHasTheGrainOfSpeckle) {
  const SpeckleBed bed(ProbeKind::phased, 192, 300, 0.003, 0.1);
  Scene scene = plainScene({medium("tissue", 1060, 1540, 15, 0.1)});
  scene.probe = bed.probe;
  scene.signal.beam_width = BeamWidth::profile;
  scene.artefacts.clutter_length_m = 0.1;
  scene.artefacts.clutter_time_s = 0.05;
  scene.artefacts.clutter_db = 0;
  scene.artefacts.clutter_width_rad = 0;
  scene.signal.receive_f_number = 2;
  const BeamView view(bed.probe, PointSpread(scene));
  for (const double path_m : {0.006, 0.012, 0.02, 0.05}) {
    const double sigma = view.lateralLines(path_m);
    const int apart = static_cast<int>(std::lround(sigma));
    const auto [correlation, mean] = clutterAt(scene, path_m, apart);
    EXPECT_NEAR(correlation, std::exp(-0.5 * apart * apart / (sigma * sigma)), 0.1) << path_m;
    EXPECT_NEAR(mean / std::exp(-path_m / 0.1), 1, 0.1) << path_m;
  }
}

}  // namespace
}  // namespace echocine::receive_aperture_law
