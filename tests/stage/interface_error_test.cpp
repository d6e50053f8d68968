// Where interfaces stand: a wall at a known depth, seen through few lines and long samples.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "metrics/interface_error.h"
#include "scene/scan_geometry.h"
#include "support/plain_scene.h"

namespace echocine {
namespace {

Probe probeOf(int lines, int samples) {
  Probe probe = support::plainScene({}).probe;
  probe.lines = lines;
  probe.samples = samples;
  return probe;
}

// Every line meets surface 0 at the depth that `depth_m` has for the line's angle.
template <typename Depth>
InterfaceMap mapOf(const Probe& probe, const Depth& depth_m) {
  InterfaceMap map{probe, {}};
  for (int i = 0; i < probe.lines; ++i) {
    const double angle =
        std::atan2(lineGeometry(probe, i).direction.x, lineGeometry(probe, i).direction.z);
    map.lines.push_back({{SurfaceId{0}, true, depth_m(angle)}});
  }
  return map;
}

TEST(InterfaceError, OfAMapAgainstItselfIsTheRoundingToSampleCentres) {
  const Probe probe = probeOf(65, 160);  // 1 mm samples
  const InterfaceMap map = mapOf(probe, [](double) { return 0.0503; });
  InterfaceError error;
  error.add(map, map);
  EXPECT_NEAR(error.rms_m(), 0.2e-3, 1e-9);  // the centre is at 50.5 mm
  EXPECT_NEAR(error.percentile95_m(), 0.2e-3, 1e-9);
  EXPECT_EQ(error.missedShare(), 0);
}

TEST(InterfaceError, AShiftOfAnArcIsTheShift) {
  const InterfaceMap truth = mapOf(probeOf(129, 16000), [](double) { return 0.05; });
  const InterfaceMap moved = mapOf(probeOf(129, 16000), [](double) { return 0.052; });
  InterfaceError error;
  error.add(moved, truth);
  EXPECT_NEAR(error.rms_m(), 2e-3, 1e-5);
}

// A flat wall is straight between lines too: few lines draw it where it is, however oblique.
TEST(InterfaceError, AFlatWallNeedsNoManyLines) {
  const auto wall = [](double angle) { return 0.04 / std::cos(angle + 0.5); };
  const InterfaceMap truth = mapOf(probeOf(257, 1000), wall);
  InterfaceError error;
  error.add(mapOf(probeOf(5, 1 << 20), wall), truth);
  EXPECT_LT(error.rms_m(), 1e-6);
}

// A circle around a full-turn probe, whose lines close: the sagitta again, at the seam too.
TEST(InterfaceError, AFullTurnClosesAtItsSeam) {
  const auto turnOf = [](int lines, int samples) {
    Probe probe = probeOf(lines, samples);
    probe.kind = ProbeKind::radial;
    probe.first_angle_rad = -std::numbers::pi;
    probe.last_angle_rad = std::numbers::pi;
    return probe;
  };
  const auto circle = [](double) { return 0.1; };
  InterfaceError error;
  error.add(mapOf(turnOf(12, 1 << 20), circle), mapOf(turnOf(996, 1000), circle));
  const double sagitta = 0.1 * (1 - std::cos(std::numbers::pi / 12));
  EXPECT_LT(error.percentile95_m(), sagitta);
  EXPECT_NEAR(error.rms_m(), std::sqrt(8.0 / 15) * sagitta, 0.01 * sagitta);
}

// An arc of radius r drawn by chords of N lines: the sagitta r (1 - cos(d/2)) at most.
TEST(InterfaceError, AnArcDrawnByChordsErrsByTheirSagitta) {
  const Probe few = probeOf(6, 1 << 20), many = probeOf(1001, 1000);
  InterfaceError error;
  error.add(mapOf(few, [](double) { return 0.1; }), mapOf(many, [](double) { return 0.1; }));
  const double step = (few.last_angle_rad - few.first_angle_rad) / 5;
  const double sagitta = 0.1 * (1 - std::cos(step / 2));
  EXPECT_LT(error.percentile95_m(), sagitta);
  EXPECT_GT(error.percentile95_m(), 0.98 * sagitta);
  // Of a parabola over its chord the RMS is sqrt(8/15) of the sagitta.
  EXPECT_NEAR(error.rms_m(), std::sqrt(8.0 / 15) * sagitta, 0.01 * sagitta);
}

TEST(InterfaceError, WhatIsNotThereIsMissed) {
  const Probe probe = probeOf(9, 160);
  const InterfaceMap truth = mapOf(probe, [](double) { return 0.05; });
  InterfaceMap other = truth;
  for (auto& line : other.lines) line[0].surface = SurfaceId{1};
  InterfaceMap far = mapOf(probe, [](double) { return 0.1; });
  InterfaceMap half = truth;
  for (std::size_t i = 0; i < 3; ++i) half.lines[i].clear();
  InterfaceError of_other, of_far, of_half;
  of_other.add(other, truth);
  of_far.add(far, truth);
  of_half.add(half, truth);
  EXPECT_EQ(of_other.missedShare(), 1);
  EXPECT_EQ(of_other.rms_m(), 0);
  EXPECT_EQ(of_far.missedShare(), 1);
  EXPECT_NEAR(of_half.missedShare(), 3.0 / 9, 1e-12);
}

}  // namespace
}  // namespace echocine
