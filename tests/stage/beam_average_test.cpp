// The average over the beam's width and the pulse's length.

#include "signal/beam_width.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "support/plain_scene.h"

namespace echocine {
namespace {

using namespace support;

constexpr int kLines = 41, kSamples = 80;

Probe linearProbe() {
  Probe p = plainScene({medium("m", 1000, 1500)}).probe;
  p.kind = ProbeKind::linear;
  p.first_angle_rad = p.last_angle_rad = 0;
  p.first_offset_m = -0.02;
  p.last_offset_m = 0.02;   // 1 mm from line to line
  p.max_depth_m = 0.08;     // 1 mm from sample to sample
  p.frequency_hz = 1.54e6;  // wavelength 1 mm
  p.lines = kLines;
  p.samples = kSamples;
  return p;
}

SignalSettings averaging(double width_mm, double pulse_cycles) {
  SignalSettings s;
  s.beam_width = width_mm > 0 ? BeamWidth::fixed : BeamWidth::none;
  s.beam_width_m = width_mm * 1e-3;
  s.pulse_cycles = pulse_cycles;
  return s;
}

std::vector<float> averaged(const Probe& probe, const SignalSettings& settings,
                            std::vector<float> plane) {
  BeamAverage(probe, settings).apply(plane);
  return plane;
}

std::vector<float> impulse(int line, int sample) {
  std::vector<float> plane(kLines * kSamples, 0.0f);
  plane[static_cast<std::size_t>(line * kSamples + sample)] = 1;
  return plane;
}

double at(const std::vector<float>& plane, int line, int sample) {
  return plane[static_cast<std::size_t>(line * kSamples + sample)];
}

// Weights sum to 1, also where the window is cut by the picture's edge.
TEST(BeamAverage, AConstantStaysConstantAlsoAtTheEdges) {
  for (const auto& [width, cycles] :
       {std::pair(0.0, 0.0), {3.0, 0.0}, {0.0, 7.0}, {4.7, 5.3}, {500.0, 300.0}})
    for (const float value :
         averaged(linearProbe(), averaging(width, cycles), std::vector(kLines * kSamples, 0.7f)))
      ASSERT_NEAR(value, 0.7f, 1e-6) << width << ' ' << cycles;
}

TEST(BeamAverage, FocusedWidthsKeepAConstantToo) {
  Scene scene = plainScene({medium("m", 1000, 1500)});
  scene.probe.lines = kLines;
  for (const float value :
       averaged(scene.probe, scene.signal, std::vector<float>(kLines * 160, 3.0f)))
    ASSERT_NEAR(value, 3.0f, 3e-6);
}

TEST(BeamAverage, WithoutWidthAndPulseNothingChanges) {
  const std::vector<float> plane = impulse(20, 40);
  EXPECT_EQ(averaged(linearProbe(), averaging(0, 0), plane), plane);
  EXPECT_EQ(averaged(linearProbe(), averaging(0.9, 1), plane),
            plane);  // narrower than a line and a sample
}

// A window that is not centred shifts walls, in proportion to its width.
TEST(BeamAverage, AnImpulseSpreadsCentredAndSymmetric) {
  const std::vector<float> plane = averaged(linearProbe(), averaging(4.7, 10.6), impulse(20, 40));
  for (int d = 1; d < 10; ++d) {
    EXPECT_FLOAT_EQ(at(plane, 20 - d, 40), at(plane, 20 + d, 40)) << d;
    EXPECT_FLOAT_EQ(at(plane, 20, 40 - d), at(plane, 20, 40 + d)) << d;
  }
  EXPECT_EQ(*std::max_element(plane.begin(), plane.end()), plane[20 * kSamples + 40]);
}

TEST(BeamAverage, TheBoxIsAsWideAsAskedWithFractionalEnds) {
  // 4.6 lines: the line itself, two neighbours less 0.2 on either side; 5.3 mm of pulse: 5.3
  // samples.
  const std::vector<float> across = averaged(linearProbe(), averaging(4.6, 0), impulse(20, 40));
  EXPECT_NEAR(at(across, 20, 40), 1 / 4.6, 1e-6);
  EXPECT_NEAR(at(across, 21, 40), 1 / 4.6, 1e-6);
  EXPECT_NEAR(at(across, 22, 40), 0.8 / 4.6, 1e-6);
  EXPECT_EQ(at(across, 23, 40), 0);
  const std::vector<float> along = averaged(linearProbe(), averaging(0, 10.6), impulse(20, 40));
  EXPECT_NEAR(at(along, 20, 40), 1 / 5.3, 1e-6);
  EXPECT_NEAR(at(along, 20, 42), 1 / 5.3, 1e-6);
  EXPECT_NEAR(at(along, 20, 43), 0.15 / 5.3, 1e-6);
  EXPECT_EQ(at(along, 20, 44), 0);
}

TEST(BeamAverage, KeepsTheSumOfWhatLiesInside) {
  const std::vector<float> plane = averaged(linearProbe(), averaging(6.3, 13), impulse(20, 40));
  EXPECT_NEAR(std::accumulate(plane.begin(), plane.end(), 0.0), 1, 1e-5);
}

// Running sums that are added and taken away leave rounding of bright echoes behind, 100 dB below
// and visible.
TEST(BeamAverage, LeavesNothingOfABrightEchoOutsideItsWindow) {
  std::vector<float> plane(kLines * kSamples, 1e-9f);
  plane[3 * kSamples + 40] = 1e6f;
  const std::vector<float> result = averaged(linearProbe(), averaging(4, 0), plane);
  for (int line = 10; line < kLines; ++line) EXPECT_NEAR(at(result, line, 40), 1e-9, 1e-10) << line;
}

TEST(BeamAverage, OneLineAndOneSampleAreTheirOwnAverage) {
  Probe probe = linearProbe();
  probe.lines = 1;
  probe.samples = 1;
  EXPECT_EQ(averaged(probe, averaging(5, 9), {0.25f}), std::vector<float>{0.25f});
}

// Two ways of equal bells: at the focus 1.2067 lambda F / D over sqrt 2.
TEST(FocusedBeamWidth, IsTheDiffractionWidthAtTheFocusAndNarrowerThanTheApertureBefore) {
  EXPECT_NEAR(focusedBeamWidth(0.08, 0.02, 0.08, 6e-4), 1.2067 * 6e-4 * 4 / std::sqrt(2.0), 1e-9);
  EXPECT_EQ(focusedBeamWidth(0, 0.02, 0.08, 6e-4), 0);
  for (double z = 0.001; z < 0.2; z += 0.001) {
    EXPECT_GT(focusedBeamWidth(z, 0.02, 0.08, 6e-4), 0);
    EXPECT_LE(focusedBeamWidth(z, 0.02, 0.08, 6e-4), 1.2067 * 6e-4 * z / 0.02);
  }
}

}  // namespace
}  // namespace echocine
