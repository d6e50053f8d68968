// Walls under several rays per beam: steep ones, where one ray leaves gaps, and smooth ones, where
// both ways to average over the beam must agree.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "scene/beam_profile.h"
#include "scene/scan_geometry.h"
#include "signal/signal_chain.h"
#include "support/beam_world.h"
#include "support/random_world.h"

namespace echocine {
namespace {

using namespace support;

// Relative variation of a wall's echo over the depths that it spans, 10 degrees to the beams.
double steepVariation(int rays) {
  World world =
      sheetWorld(rotated(sheet(1, 0.5, 0), {0, 1, 0}, radiansFromDegrees(80)).moved({0, 0, 0.08}));
  Probe& p = world.scene.probe;
  p.kind = ProbeKind::linear;
  p.first_angle_rad = p.last_angle_rad = 0;
  p.first_offset_m = -0.01;
  p.last_offset_m = 0.01;
  p.lines = 41;
  p.samples = 320;
  const PolarFrame polar =
      traceWorld(world, beamPlan(world.scene, rays, true, false), Tracer::embree);
  double sum = 0, squares = 0;
  constexpr std::size_t kFrom = 120, kTo = 200;  // 60 to 100 mm, where inner lines meet it
  for (std::size_t k = kFrom; k < kTo; ++k) {
    double echo = 0;
    for (std::size_t line = 0; line < 41; ++line)
      echo += static_cast<double>(polar.planes.at(Channel::reflection)[line * 320 + k]);
    sum += echo;
    squares += echo * echo;
  }
  const double mean = sum / (kTo - kFrom);
  return std::sqrt(squares / (kTo - kFrom) / (mean * mean) - 1);
}

// Spread over its stratum each ray covers the depths between its neighbours, so gaps close long
// before rays are dense.
TEST(BeamAverageLaw, ASteepWallsEchoVariesLessTheMoreRaysThereAre) {
  const double one = steepVariation(1), few = steepVariation(8), many = steepVariation(128);
  std::printf("variation with 1, 8, 128 rays: %.2f, %.3f, %.4f\n", one, few, many);
  EXPECT_GT(one, 1);  // a string of beads
  EXPECT_LT(few, 0.15);
  EXPECT_LT(many, 0.02);
}

// One line and a wall 10 degrees to it: what comes back from each depth is the two-way beam's share
// that meets the wall there, the bell at the slope S(z) = (z - z_0) / (z tan 80) times dS/dz.
TEST(BeamAverageLaw, ASteepWallShowsTheBeamsProfileAlongTheDepth) {
  constexpr double z_0 = 0.08;
  const double tan_80 = std::tan(radiansFromDegrees(80));
  const World world =
      sheetWorld(rotated(sheet(1, 0.5, 0), {0, 1, 0}, radiansFromDegrees(-80)).moved({0, 0, z_0}));
  const Probe& p = world.scene.probe;
  const double whole = wholeEcho(world);
  const std::vector<float> echo =
      traceWorld(world, beamPlan(world.scene, 64, true, false), Tracer::embree)
          .planes.at(Channel::reflection);
  const Sampling sampling = samplingOf(p);
  double difference = 0, sum = 0;
  for (std::size_t k = 400; k < 1200; ++k) {  // 40 to 120 mm
    const double z = sampling.centre(static_cast<double>(k));
    const double sigma =
        focusedBeamWidth(z, p.aperture_m, p.focus_m, ScanGeometry(p).wavelength()) /
        kWidthPerDeviation / z;
    const double slope = (z - z_0) / (z * tan_80), per_depth = z_0 / (z * z * tan_80);
    const double bell =
        std::exp(-slope * slope / (2 * sigma * sigma)) / (sigma * std::sqrt(2 * std::numbers::pi));
    const double expected = bell * per_depth * sampling.spacing_m;
    difference += std::abs(static_cast<double>(echo[k]) / whole - expected);
    sum += expected;
  }
  std::printf("difference from the beam's profile: %.3f of %.3f\n", difference, sum);
  EXPECT_NEAR(sum, 1, 0.05);  // the beam widens with depth
  EXPECT_LT(difference, 0.06);
}

// On walls that are smooth over a beam both ways of taking its average mean the same.
// Where walls run across the beam, the paper's average and the traced beam must say the same.
TEST(BeamAverageLaw, TheFilterAgreesWithTheRaysOnASmoothWallAtTheFocus) {
  World world{plainScene({medium("water", 1000, 1540), medium("wall", 1100, 1540)}),
              {icosphere(5, 0.1).moved({0.02, 0, 0.18})}};
  addStructure(world.scene, 1, 0);
  world.scene.structures[0].reflection_exponent = 2;
  world.scene.probe.lines = 129;
  world.scene.probe.samples = 640;
  world.scene.effects.elevation = Switch::off;
  const auto shown = [&](int rays) {
    const EffectPlan plan = beamPlan(world.scene, rays, true, false);
    PolarFrame polar = traceWorld(world, plan, Tracer::embree);
    SignalChain(world.scene, plan).process(polar.intensities);
    return polar.intensities.values;
  };
  const std::vector<float> filtered = shown(1), rays = shown(256);
  double worst_db = 0;
  for (std::size_t line = 50; line < 90; ++line) {
    const auto echo = [&](const std::vector<float>& signal) {
      const auto begin = signal.begin() + static_cast<std::ptrdiff_t>(line * 640);
      return std::accumulate(begin, begin + 480, 0.0);  // to 120 mm: the front alone
    };
    worst_db = std::max(worst_db, std::abs(10 * std::log10(echo(filtered) / echo(rays))));
  }
  std::printf("filter against rays: %.3f dB at most\n", worst_db);
  EXPECT_LT(worst_db, 0.2);
}

}  // namespace
}  // namespace echocine
