// A radial probe's lines go all round. What holds within a sector holds across its seam, where the
// last line is a neighbour of the first.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/scan_geometry.h"
#include "signal/signal_chain.h"
#include "support/plain_scene.h"
#include "support/world.h"

namespace echocine {
namespace {

using support::addStructure;
using support::medium;
using support::plainScene;
using support::Tracer;
using support::World;

constexpr double kTurn = 2 * std::numbers::pi;

Probe radialProbe(int lines, int samples = 200) {
  Probe probe = plainScene({medium("water", 1000, 1540)}).probe;
  support::lookAllRound(0.004, probe);
  probe.min_depth_m = 0.001;
  probe.max_depth_m = 0.06;
  probe.frequency_hz = 6e6;
  probe.aperture_m = 0.006;
  probe.focus_m = 0.03;
  probe.lines = lines;
  probe.samples = samples;
  return probe;
}

TEST(RadialProbe, LinesGoRoundInEqualSteps) {
  const Probe probe = radialProbe(20);
  for (int i = 0; i < 20; ++i) {
    const LineGeometry line = lineGeometry(probe, i), next = lineGeometry(probe, (i + 1) % 20);
    EXPECT_NEAR(length(line.direction), 1, 1e-15);
    EXPECT_LT(length(line.origin - 0.004 * line.direction), 1e-17);
    EXPECT_NEAR(dot(line.direction, next.direction), std::cos(kTurn / 20), 1e-14);
    EXPECT_NEAR(cross(line.direction, next.direction).y, std::sin(kTurn / 20), 1e-14);
  }
  EXPECT_NEAR(lineSpacing(probe, 0.05), 0.054 * kTurn / 20, 1e-16);
}

TEST(RadialProbe, EveryPlaceOfThePlaneHasALine) {
  const Probe probe = radialProbe(37);
  const ScanGeometry geometry(probe);
  for (int step = 0; step < 1000; ++step) {
    const double angle = -std::numbers::pi + kTurn * (step + 0.25) / 1000, r = 0.02;
    const double x = r * std::sin(angle), z = r * std::cos(angle);
    const auto at = geometry.beamPosition(x, z);
    ASSERT_TRUE(at);
    EXPECT_GE(at->line, 0);
    EXPECT_LT(at->line, 37);
    EXPECT_NEAR(at->path_m, r - 0.004, 1e-15);
    EXPECT_TRUE(inScanArea(probe, x, z));
    // The line nearest by number is the nearest by direction.
    const int nearest = geometry.nearestLine(at->line);
    const auto towards = [&](int line) {
      return dot(lineGeometry(probe, line).direction, {x / r, 0, z / r});
    };
    for (int i = 0; i < 37; ++i)
      EXPECT_LE(towards(i), towards(nearest) + 1e-12) << step << " " << i;
    // Beside a place on the other side of the seam the position is the same.
    const Vec3d known{0.0195 * std::sin(angle + 0.02), 0, 0.0195 * std::cos(angle + 0.02)};
    const auto beside = geometry.beamPositionBeside(known, geometry.placeOf(known), {x, 0, z});
    ASSERT_TRUE(beside);
    const double apart = std::abs(beside->line - at->line);
    EXPECT_LT(std::min(apart, 37 - apart), 1e-9);
  }
}

// Bodies of different media on all sides, one of them across the seam behind the probe, one round
// it, and a membrane that ends beside the seam.
World bodies(const Probe& probe) {
  World world{plainScene({medium("water", 1000, 1540, 1, 1e-3), medium("wall", 1100, 1600, 5, 1e-2),
                          medium("fat", 950, 1450, 8, 5e-3)}),
              {}};
  world.scene.probe = probe;
  const auto ball = [&](Vec3d centre, double radius, std::size_t of, int priority) {
    support::Mesh mesh = support::icosphere(3, radius);
    for (Vec3d& p : mesh.points) p = p + centre;
    world.meshes.push_back(mesh);
    addStructure(world.scene, of, priority);
  };
  ball({0.003, 0.001, -0.03}, 0.0123, 1, 3);
  ball({0.02, 0.002, 0.011}, 0.0081, 2, 2);
  ball({-0.021, 0, -0.008}, 0.007, 1, 1);
  ball({0.001, 0.0005, 0.002}, 0.0473, 2, 0);
  return world;
}

World turnedBy(World world, double angle) {
  for (support::Mesh& mesh : world.meshes)
    for (Vec3d& p : mesh.points)
      p = {std::cos(angle) * p.x + std::sin(angle) * p.z, p.y,
           std::cos(angle) * p.z - std::sin(angle) * p.x};
  return world;
}

// The largest difference between line i of a plane and line i + turned of another, relative to the
// plane's largest value.
double differenceOf(const std::vector<float>& a, const std::vector<float>& b, const Probe& probe,
                    int turned) {
  double most = 0, largest = 0;
  for (int i = 0; i < probe.lines; ++i)
    for (int k = 0; k < probe.samples; ++k) {
      const auto at = [&](int line) {
        return static_cast<std::size_t>(line % probe.lines * probe.samples + k);
      };
      const double one = static_cast<double>(a[at(i)]),
                   other = static_cast<double>(b[at(i + turned)]);
      most = std::max(most, std::abs(one - other));
      largest = std::max(largest, one);
    }
  return most / largest;
}

// Lines are the same whichever side of the seam they lie on: what turns with the bodies is the
// number of the line alone. Coordinates are rounded to floats, 4 nm here.
TEST(RadialProbe, TurningTheBodiesTurnsTheLines) {
  const Probe probe = radialProbe(48);
  const World world = bodies(probe);
  for (const Tracer tracer : support::kTracers)
    for (const int lines : {7, 24, 41}) {
      const PolarFrame at_rest = traceWorld(world, tracer);
      const PolarFrame turned = traceWorld(turnedBy(world, lines * kTurn / 48), tracer);
      EXPECT_LT(differenceOf(at_rest.intensities.values, turned.intensities.values, probe, lines),
                2e-3)
          << nameOf(tracer) << " " << lines;
    }
}

// The lines of a curvilinear probe of the same face are those of the turn that it has a part of.
TEST(RadialProbe, ItsLinesAreThoseOfACurvilinearProbe) {
  const Probe radial = radialProbe(90);
  Probe curved = radial;
  curved.kind = ProbeKind::curvilinear;
  curved.lines = 41;  // lines 25 to 65
  curved.first_angle_rad = -20 * kTurn / 90 + kTurn / 180;
  curved.last_angle_rad = 20 * kTurn / 90 + kTurn / 180;
  for (const Tracer tracer : {Tracer::slice, Tracer::embree}) {
    const PolarFrame whole = traceWorld(bodies(radial), tracer),
                     part = traceWorld(bodies(curved), tracer);
    for (int i = 0; i < 41; ++i)
      for (int k = 0; k < radial.samples; ++k)
        ASSERT_NEAR(part.intensities[static_cast<std::size_t>(i * 200 + k)],
                    whole.intensities[static_cast<std::size_t>((i + 25) * 200 + k)], 1e-9)
            << nameOf(tracer) << " line " << i << ", sample " << k;
  }
}

// Every stage of the signal chain across the lines: box and profile of the beam, and haze.
TEST(RadialProbe, TheSignalChainHasNoSeam) {
  const Probe probe = radialProbe(64, 256);
  for (const BeamWidth width : {BeamWidth::focused, BeamWidth::profile}) {
    Scene scene = plainScene({medium("water", 1000, 1540, 0, 1e-3)});
    scene.probe = probe;
    scene.signal.beam_width = width;
    scene.signal.edge_enhancement = 0.5;
    scene.artefacts.haze = true;
    scene.artefacts.haze_db = -20;
    scene.artefacts.haze_width_rad = 0.4;
    EffectPlan plan = planEffects(scene);
    plan.haze = plan.beam_width = plan.edge_enhancement = true;
    plan.rays_per_beam = 1;
    const SignalChain chain(scene, plan);
    const auto made = [&](int line) {
      std::vector<float> plane(64 * 256, 1e-6f);
      for (int k = 0; k < 256; k += 9) plane[static_cast<std::size_t>(line * 256 + k)] = 1;
      Intensities intensities(std::move(plane));
      chain.process(intensities);
      Intensities received = intensities;
      const Greys greys = chain.compress(std::move(intensities), 1);
      return std::pair(received.values, greys.values);
    };
    // Whole groups of lines of the profile, so that its far side lobes are cut alike.
    const auto [middle, middle_greys] = made(32);
    for (const int turned : {32, 16, 48}) {
      const auto [seam, seam_greys] = made((32 + turned) % 64);
      EXPECT_LT(differenceOf(middle, seam, probe, turned), 1e-4) << turned;
      EXPECT_LT(differenceOf(middle_greys, seam_greys, probe, turned), 1e-2) << turned;
    }
  }
}

// Lines behind an aperture weigh nothing on either side: a wide curved array is its own mirror.
TEST(CurvilinearProbe, ProfilesOfAWideSectorAreAlikeOnBothSides) {
  Scene scene = plainScene({medium("water", 1000, 1540, 0, 1e-3)});
  scene.probe = radialProbe(61, 64);
  scene.probe.kind = ProbeKind::curvilinear;
  scene.probe.first_angle_rad = -radiansFromDegrees(85);
  scene.probe.last_angle_rad = radiansFromDegrees(85);
  scene.signal.beam_width = BeamWidth::profile;
  EffectPlan plan = planEffects(scene);
  plan.beam_width = true;
  const SignalChain chain(scene, plan);
  const auto made = [&](int line) {
    std::vector<float> plane(61 * 64, 0.0f);
    for (int k = 0; k < 64; ++k) plane[static_cast<std::size_t>(line * 64 + k)] = 1;
    Intensities intensities(std::move(plane));
    chain.process(intensities);
    return intensities.values;
  };
  const std::vector<float> left = made(4), right = made(56);
  for (int i = 0; i < 61; ++i)
    for (int k = 0; k < 64; ++k) {
      const double one = left[static_cast<std::size_t>(i * 64 + k)],
                   other = right[static_cast<std::size_t>((60 - i) * 64 + k)];
      ASSERT_NEAR(one, other, 1e-4 * one + 1e-7) << i << " " << k;
    }
}

// A constant plane stays constant: no window loses weight at the seam.
TEST(RadialProbe, AConstantPlaneStaysConstant) {
  Scene scene = plainScene({medium("water", 1000, 1540, 0, 1e-3)});
  scene.probe = radialProbe(40, 128);
  for (const BeamWidth width : {BeamWidth::focused, BeamWidth::profile}) {
    scene.signal.beam_width = width;
    EffectPlan plan = planEffects(scene);
    plan.beam_width = true;
    Intensities plane(std::vector<float>(40 * 128, 0.25f));
    SignalChain(scene, plan).process(plane);
    for (const float value : plane) ASSERT_NEAR(value, 0.25f, 1e-6f);
  }
}

// Haze of one line, by its closed form over infinitely many turns.
TEST(RadialProbe, HazeGoesRoundTheTurn) {
  const Probe probe = radialProbe(24, 4);
  constexpr double kWidth = 0.7;
  const LateralHaze haze(probe, 0, kWidth);
  std::vector<float> plane(24 * 4, 0.0f);
  for (int k = 0; k < 4; ++k) plane[static_cast<std::size_t>(22 * 4 + k)] = 1;
  haze.add(plane);
  const double a = std::exp(-kTurn / 24 / kWidth);
  for (int i = 0; i < 24; ++i) {
    double sum = 0;
    for (int turn = -60; turn <= 60; ++turn) sum += std::pow(a, std::abs(i - 22 + 24 * turn));
    const double expected = (i == 22 ? 1 : 0) + sum * (1 - a) / (1 + a);
    EXPECT_NEAR(plane[static_cast<std::size_t>(i * 4)], expected, 2e-6) << i;
  }
}

// Between the last line and the first the picture is interpolated as between any others.
TEST(RadialProbe, ThePictureHasNoSeam) {
  Scene scene = plainScene({medium("water", 1000, 1540)});
  scene.probe = radialProbe(32, 64);
  scene.output.width = scene.output.height = 301;
  scene.output.ecg = scene.output.depth_ticks = false;
  const PictureGeometry geometry = pictureGeometry(scene);
  const ScanConverter converter(scene.probe, geometry, 301, 301, GreyCurve());
  std::vector<float> greys;  // a wave that goes three times round
  const ScanGeometry lines(scene.probe);
  for (int i = 0; i < 32; ++i)
    for (int k = 0; k < 64; ++k)
      greys.push_back(0.5f + 0.4f * static_cast<float>(std::cos(
                                        3 * (lines.firstPlace() + i * lines.cellWidth()))));
  std::vector<float> picture;
  converter.convert(greys, picture);
  int inside = 0;
  for (int y = 0; y < 301; ++y)
    for (int x = 0; x < 301; ++x) {
      const double u = (x + 0.5 - geometry.origin_x_px) * geometry.metres_per_pixel,
                   v = (y + 0.5 - geometry.origin_y_px) * geometry.metres_per_pixel;
      const float value = picture[static_cast<std::size_t>(y * 301 + x)];
      const double path = std::hypot(u, v) - 0.004;
      if (path < 0.0011 || path > 0.0599) continue;
      ++inside;
      // The chord of a cosine is off by (3 pitch)^2 / 8 of its size.
      ASSERT_NEAR(value, 0.5 + 0.4 * std::cos(3 * std::atan2(u, v)), 0.4 * 0.35 / 8 + 1e-4)
          << x << " " << y;
    }
  EXPECT_GT(inside, 50000);
}

}  // namespace
}  // namespace echocine
