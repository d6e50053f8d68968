// Echoes of bent lines over the beams' cells: as much energy as at the lines, without beads.
// Oracle: many lines in one cell, each with its echoes where it meets the wall.

#include <gtest/gtest.h>

#include "scene/scan_geometry.h"
#include "support/plain_scene.h"
#include "support/world.h"

namespace echocine {
namespace {

using namespace support;

// A slow lens before a wall, both across the imaging plane; nothing scatters.
World lensAndWall(ProbeKind kind, const Mesh& wall) {
  World world;
  world.scene = plainScene(
      {medium("blood", 1060, 1570), medium("lens", 1060, 1450), medium("wall", 1100, 1540)});
  addStructure(world.scene, 1, 1);
  addStructure(world.scene, 2, 2);
  Mesh lens = box({-0.2, -0.05, 0}, {0.2, 0.05, 0.01});
  for (Vec3d& p : lens.points)  // a prism of 8 degrees, so that lines bend unevenly
    p.z = p.z < 0.005 ? 0.02 : 0.03 + std::tan(radiansFromDegrees(8)) * p.x / 3;
  world.meshes = {lens, wall};
  Probe& probe = world.scene.probe;
  probe.kind = kind;
  probe.lines = 128;
  probe.samples = 1024;
  if (kind == ProbeKind::linear) {
    probe.first_angle_rad = probe.last_angle_rad = 0;
    probe.first_offset_m = -0.02;
    probe.last_offset_m = 0.02;
  } else {
    probe.first_angle_rad = radiansFromDegrees(-25);
    probe.last_angle_rad = radiansFromDegrees(25);
  }
  world.scene.output.channels = {Channel::unattenuated};
  return world;
}

// A slab whose front stands at `angle` to the z axis and passes through x = 0 at 80 mm.
Mesh steepSlab(double angle_deg) {
  const double a = radiansFromDegrees(angle_deg);
  Mesh m = box({0, -0.05, -0.5}, {0.5, 0.05, 0.5});
  for (Vec3d& p : m.points)
    p = {p.x * std::cos(a) + p.z * std::sin(a), p.y, 0.08 - p.x * std::sin(a) + p.z * std::cos(a)};
  return m;
}

PolarFrame traced(const World& world, EchoCells cells, bool bent = true) {
  EffectPlan plan = planEffects(world.scene);
  plan.refraction = bent;
  const TraceSettings settings(world.scene, plan, cells);
  const std::vector<SurfaceTopology> topology = world.topology();
  PolarFrame polar;
  PlaneRequest request = planeRequest(world.scene, plan);
  request.intensities = false;
  if (cells == EchoCells::contours) {
    PlaneSlice slice(topology, world.scene.probe);
    slice.update(world.frame());
    traceFrame(slice, world.scene.probe, settings, request, polar);
  } else {
    FrameGeometry geometry(topology);
    geometry.update(world.frame());
    traceFrame(geometry, world.scene.probe, settings, request, polar);
  }
  return polar;
}

std::vector<double> echoesOf(const World& world, EchoCells cells, bool bent = true) {
  const PolarFrame polar = traced(world, cells, bent);
  const std::vector<float>& plane = polar.planes.at(Channel::unattenuated);
  return {plane.begin(), plane.end()};
}

double total(const std::vector<double>& plane) {
  double sum = 0;
  for (const double value : plane) sum += value;
  return sum;
}

// What the cells of lines first to last send back on the mean of `rays` lines in each.
std::vector<double> brute(const World& world, int first, int last, int rays) {
  World fine = world;
  Probe& probe = fine.scene.probe;
  const ScanGeometry geometry(probe);
  const double begin = geometry.cellBorder(first), end = geometry.cellBorder(last + 1);
  probe.lines = (last - first + 1) * rays;
  const double half = (end - begin) / probe.lines / 2;
  double& from = geometry.angular() ? probe.first_angle_rad : probe.first_offset_m;
  double& to = geometry.angular() ? probe.last_angle_rad : probe.last_offset_m;
  from = begin + half;
  to = end - half;
  const std::vector<double> all = echoesOf(fine, EchoCells::none);
  const auto samples = static_cast<std::size_t>(probe.samples);
  std::vector<double> mean(static_cast<std::size_t>(last - first + 1) * samples);
  for (std::size_t i = 0; i < all.size(); ++i)
    mean[i / samples / static_cast<std::size_t>(rays) * samples + i % samples] += all[i] / rays;
  return mean;
}

// Of two planes: what stands elsewhere, over what there is. Each difference once.
double misplaced(const std::vector<double>& a, const std::vector<double>& b) {
  double difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference += std::abs(a[i] - b[i]);
  return difference / (total(a) + total(b));
}

class BentSteepWall : public testing::TestWithParam<ProbeKind> {};

TEST_P(BentSteepWall, KeepsItsEnergyAtEveryAngle) {
  for (const double angle : {2.0, 10.0, 30.0, 60.0, 85.0}) {
    const World world = lensAndWall(GetParam(), steepSlab(angle));
    const double cells = total(echoesOf(world, EchoCells::links)),
                 centres = total(echoesOf(world, EchoCells::none));
    ASSERT_GT(centres, 0);
    EXPECT_NEAR(cells / centres, 1, 0.02) << angle << " degrees";
  }
}

TEST_P(BentSteepWall, StandsInTheSamplesWhereManyRaysMeetIt) {
  const int first = 70, last = 74;
  for (const double angle : {10.0, 30.0, 60.0, 85.0}) {
    const World world = lensAndWall(GetParam(), steepSlab(angle));
    const auto part = [&](const std::vector<double>& plane) {
      const auto samples = static_cast<std::ptrdiff_t>(world.scene.probe.samples);
      return std::vector<double>(plane.begin() + first * samples,
                                 plane.begin() + (last + 1) * samples);
    };
    const std::vector<double> expected = brute(world, first, last, 100);
    const double cells = misplaced(part(echoesOf(world, EchoCells::links)), expected);
    const double centres = misplaced(part(echoesOf(world, EchoCells::none)), expected);
    std::printf("[          ] %g degrees: misplaced %.4f with links, %.2f with centres\n", angle,
                cells, centres);
    // Behind the prism the lines no longer come from the apex: borders between cells shift.
    EXPECT_LT(cells, angle < 20 ? 0.1 : 0.02) << angle << " degrees";
    if (angle < 20) {
      EXPECT_GT(centres, 0.5);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Probes, BentSteepWall,
                         testing::Values(ProbeKind::phased, ProbeKind::linear));

// A second way to compute: nothing bends, so the plane slice knows the contours themselves.
TEST(LinkedEchoes, OfStraightLinesAreThoseOfTheContours) {
  for (const ProbeKind kind : {ProbeKind::phased, ProbeKind::linear})
    for (const double angle : {2.0, 10.0, 45.0, 85.0}) {
      World world = lensAndWall(kind, steepSlab(angle));
      for (Medium& m : world.scene.media) m.sound_speed_m_s = 1570;
      const double apart = misplaced(echoesOf(world, EchoCells::links, false),
                                     echoesOf(world, EchoCells::contours, false));
      EXPECT_LT(apart, 0.01) << angle << " degrees";
    }
}

// Front and back of a ball meet between lines: echo runs on to there.
TEST(LinkedEchoes, RunRoundABall) {
  const World world = lensAndWall(ProbeKind::phased, icosphere(6, 0.02).moved({0.002, 0, 0.08}));
  const std::vector<double> links = echoesOf(world, EchoCells::links),
                            centres = echoesOf(world, EchoCells::none),
                            expected = brute(world, 0, 127, 20);
  EXPECT_NEAR(total(links) / total(expected), 1, 0.01);
  const double with = misplaced(links, expected), without = misplaced(centres, expected);
  EXPECT_LT(with, 0.05);
  EXPECT_LT(5 * with, without);
}

// Two walls of one medium, one behind the other and each met by its own lines, are not one.
TEST(LinkedEchoes, LeapFromNoWallToAnother) {
  World world = lensAndWall(ProbeKind::linear, box({-0.2, -0.05, 0.05}, {0.00005, 0.05, 0.06}));
  const Mesh deep = box({0.00005, -0.05, 0.10}, {0.2, 0.05, 0.11});
  Mesh& both = world.meshes.back();
  const auto offset = static_cast<std::uint32_t>(both.points.size());
  both.points.insert(both.points.end(), deep.points.begin(), deep.points.end());
  for (const Triangle& t : deep.triangles)
    both.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  const std::vector<double> plane = echoesOf(world, EchoCells::links);
  const auto samples = static_cast<std::size_t>(world.scene.probe.samples);
  const double spacing_m = world.scene.probe.sampleSpacing();
  for (std::size_t i = 0; i < plane.size(); ++i) {
    const double z = (static_cast<double>(i % samples) + 0.5) * spacing_m;
    if (z > 0.065 && z < 0.095) {
      ASSERT_EQ(plane[i], 0) << z;
    }
  }
}

}  // namespace
}  // namespace echocine
