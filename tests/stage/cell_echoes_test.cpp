// Interface echoes integrated over the beam's cell: as much energy as at the line's centre, without
// beads.

#include <gtest/gtest.h>

#include "support/measured.h"
#include "support/plain_scene.h"
#include "support/surfaces.h"

namespace echocine {
namespace {

using support::Mesh;

// Blood before a wall; both scatter nothing, so a plane holds interface echoes alone.
Scene wallScene(ProbeKind kind) {
  Scene scene = support::plainScene(
      {support::medium("blood", 1060, 1570), support::medium("wall", 1100, 1570)});
  support::addStructure(scene, 1, 1);
  Probe& probe = scene.probe;
  probe.kind = kind;
  probe.lines = 128;
  probe.samples = 1024;
  if (kind == ProbeKind::linear) {
    probe.first_angle_rad = probe.last_angle_rad = 0;
    probe.first_offset_m = -0.03;
    probe.last_offset_m = 0.03;
  }
  scene.output.channels = {Channel::unattenuated};
  return scene;
}

// A slab whose front stands at `angle` to the z axis and passes through x = 0 at the depth
// `through`.
Mesh steepSlab(double angle_deg, double through_m) {
  const double a = radiansFromDegrees(angle_deg);
  Mesh m = support::box({0, -0.05, -0.3}, {0.5, 0.05, 0.3});
  for (Vec3d& p : m.points)
    p = {p.x * std::cos(a) + p.z * std::sin(a), p.y,
         through_m - p.x * std::sin(a) + p.z * std::cos(a)};
  return m;
}

PolarFrame traced(const Scene& scene, const Mesh& mesh, bool cells, bool picture) {
  std::vector<SurfaceTopology> topology{
      {SurfaceId{0}, mesh.triangles, static_cast<std::uint32_t>(mesh.points.size()), false, false}};
  SurfaceFrame frame{{{}}};
  for (const Vec3d& p : mesh.points) frame.positions_m[0].push_back(toFloat(p));
  PlaneSlice slice(topology, scene.probe);
  slice.update(frame);
  EffectPlan plan = planEffects(scene);
  plan.refraction = false;
  PolarFrame polar;
  PlaneRequest request = planeRequest(scene, plan);
  request.intensities = picture;
  traceFrame(slice, scene.probe,
             TraceSettings(scene, plan, cells ? EchoCells::contours : EchoCells::none), request,
             polar);
  return polar;
}

std::vector<float> echoesOf(const Scene& scene, const Mesh& mesh, bool cells) {
  return traced(scene, mesh, cells, false).planes.at(Channel::unattenuated);
}

// Echo energy at each depth: the sum over lines.
std::vector<double> alongDepth(const Probe& probe, const std::vector<float>& plane) {
  std::vector<double> sums(static_cast<std::size_t>(probe.samples));
  for (std::size_t i = 0; i < plane.size(); ++i) sums[i % sums.size()] += plane[i];
  return sums;
}

struct Evenness {
  double lowest_db, highest_db;
};

Evenness spreadOver(const std::vector<double>& sums, std::size_t first, std::size_t last) {
  double lo = 1e300, hi = 0;
  for (std::size_t k = first; k < last; ++k) {
    lo = std::min(lo, sums[k]);
    hi = std::max(hi, sums[k]);
  }
  return {10 * std::log10(lo), 10 * std::log10(hi)};
}

// What a plane at distance p from the apex sends back per metre of depth, up to a factor: the lobe
// cos^2 = (p/r)^2 times the angle that a metre of depth takes, d theta / d r = p / (r sqrt(r^2 -
// p^2)). The same everywhere for parallel beams.
double expectedAt(ProbeKind kind, double p_m, double r_m) {
  if (kind == ProbeKind::linear) return 1;
  const double cos_i = p_m / r_m;
  return cos_i * cos_i * p_m / (r_m * std::sqrt(r_m * r_m - p_m * p_m));
}

class SteepWall : public testing::TestWithParam<ProbeKind> {};

TEST_P(SteepWall, AtTenDegreesToTheBeamIsEvenWithCellsAndBeadsWithout) {
  const Scene scene = wallScene(GetParam());
  const Mesh slab = steepSlab(10, 0.08);  // 10 degrees against the beam that meets it at 80 mm
  const double p_m = 0.08 * std::sin(radiansFromDegrees(10));
  const auto evenness = [&](bool cells) {
    std::vector<double> sums = alongDepth(scene.probe, echoesOf(scene, slab, cells));
    for (std::size_t k = 0; k < sums.size(); ++k) {
      const double r_m =
          scene.probe.min_depth_m + (static_cast<double>(k) + 0.5) * scene.probe.sampleSpacing();
      if (r_m > p_m) sums[k] /= expectedAt(GetParam(), p_m, r_m);
    }
    return spreadOver(sums, 400, 620);
  };
  const Evenness cells = evenness(true), centres = evenness(false);
  std::printf(
      "[          ] echo along the wall varies by %.4f dB with cells, by %.0f dB with centres\n",
      cells.highest_db - cells.lowest_db, centres.highest_db - centres.lowest_db);
  EXPECT_LT(cells.highest_db - cells.lowest_db, 1.0);  // the lobe is that of each edge's middle
  EXPECT_GT(centres.highest_db - centres.lowest_db, 30.0);
}

TEST_P(SteepWall, KeepsItsEnergyAtEveryAngle) {
  const Scene scene = wallScene(GetParam());
  for (const double angle : {2.0, 10.0, 30.0, 60.0, 85.0}) {
    const Mesh slab = steepSlab(angle, 0.08);
    const auto total = [&](bool cells) {
      double sum = 0;
      for (const double s : alongDepth(scene.probe, echoesOf(scene, slab, cells))) sum += s;
      return sum;
    };
    const double cells = total(true), centres = total(false);
    ASSERT_GT(centres, 0);
    EXPECT_NEAR(cells / centres, 1, 0.02) << angle << " degrees";
  }
}

// signal.interface_limit_db limits a wall's echo, however samples, lines and facets divide the
// wall.
TEST_P(SteepWall, HasOneLimitForAnySamplesAndLines) {
  Scene scene = wallScene(GetParam());
  support::Largest off("echo over that at the centres, less 1,", "");
  scene.signal.interface_limit_db = -60;  // the wall sends back -35 dB across the beam
  const auto mean = [&](const Mesh& slab, bool cells) {  // of a line, per metre of depth
    double sum = 0;
    for (const float echo : traced(scene, slab, cells, true).intensities) sum += echo;
    return sum * scene.probe.sampleSpacing() / scene.probe.lines;
  };
  for (const double angle : {10.0, 30.0, 60.0}) {
    const Mesh slab = steepSlab(angle, 0.08);
    scene.probe.lines = 512;
    scene.probe.samples = 1024;
    const double expected = mean(slab, false);  // each line meets the whole wall
    ASSERT_GT(expected, 0);
    for (const int lines : {64, 512})
      for (const int samples : {320, 4096}) {
        scene.probe.lines = lines;
        scene.probe.samples = samples;
        EXPECT_NEAR(off(mean(slab, true) / expected - 1), 0, 0.02)
            << angle << " degrees, " << lines << " x " << samples;
      }
  }
}

INSTANTIATE_TEST_SUITE_P(Probes, SteepWall, testing::Values(ProbeKind::phased, ProbeKind::linear));

TEST(CellEchoes, OfAWallAcrossTheBeamAreThoseAtTheCentre) {
  Scene scene = wallScene(ProbeKind::linear);
  const Mesh slab = support::box({-0.2, -0.05, 0.08004}, {0.2, 0.05, 0.12004});
  const std::vector<float> cells = echoesOf(scene, slab, true),
                           centres = echoesOf(scene, slab, false);
  for (std::size_t i = 0; i < cells.size(); ++i)
    ASSERT_NEAR(cells[i], centres[i], 1e-6f * std::max(centres[i], 1e-12f) + 1e-12f)
        << "sample " << i;
}

// Oracle: many centre-sampled lines inside one cell.
TEST(CellEchoes, EqualTheMeanOfManyRaysInTheCell) {
  Scene scene = wallScene(ProbeKind::phased);
  scene.probe.lines = 33;
  scene.probe.samples = 256;
  const Mesh ball = support::icosphere(5, 0.03).moved({0.003, 0.0005, 0.09});
  const std::vector<float> cells = echoesOf(scene, ball, true);
  Scene fine = scene;
  constexpr int kRays =
      400;  // per cell; line i's rays are those between its neighbours' half-way angles
  const double width = (scene.probe.last_angle_rad - scene.probe.first_angle_rad) / 32;
  const int line = 20;
  const double centre = scene.probe.first_angle_rad + line * width;
  fine.probe.lines = kRays;
  fine.probe.first_angle_rad = centre - width / 2 * (1 - 1.0 / kRays);
  fine.probe.last_angle_rad = centre + width / 2 * (1 - 1.0 / kRays);
  const std::vector<double> mean = alongDepth(fine.probe, echoesOf(fine, ball, false));
  double total = 0, difference = 0;
  for (std::size_t k = 0; k < 256; ++k) {
    const double expected = mean[k] / kRays, got = cells[static_cast<std::size_t>(line) * 256 + k];
    total += expected;
    difference += std::abs(got - expected);
  }
  ASSERT_GT(total, 0);
  EXPECT_LT(difference / total, 0.02);
}

// The mean of `kRays` lines in the cell of one line, each with its echoes where it meets a wall.
std::vector<double> meanInCell(const Scene& scene, const Mesh& mesh, int line) {
  constexpr int kRays = 400;
  const double width =
      (scene.probe.last_angle_rad - scene.probe.first_angle_rad) / (scene.probe.lines - 1);
  const double centre = scene.probe.first_angle_rad + line * width;
  Scene fine = scene;
  fine.probe.lines = kRays;
  fine.probe.first_angle_rad = centre - width / 2 * (1 - 1.0 / kRays);
  fine.probe.last_angle_rad = centre + width / 2 * (1 - 1.0 / kRays);
  std::vector<double> mean = alongDepth(fine.probe, echoesOf(fine, mesh, false));
  for (double& value : mean) value /= kRays;
  return mean;
}

// Of one line: what stands elsewhere than in the cell's mean, over the mean.
double misplaced(const Scene& scene, const Mesh& mesh, int line) {
  const std::vector<double> expected = meanInCell(scene, mesh, line);
  const std::vector<float> cells = echoesOf(scene, mesh, true);
  double total = 0, difference = 0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    total += expected[k];
    difference +=
        std::abs(cells[static_cast<std::size_t>(line) * expected.size() + k] - expected[k]);
  }
  EXPECT_GT(total, 0);
  return difference / total;
}

// The wall ends every line, so each cell's far half lies deeper than its line goes. The lobe is
// that of each edge's middle, which in cells this long takes 4 %.
TEST(CellEchoes, OfAWallBeyondTheCriticalAngleFillTheWholeCell) {
  Scene scene = wallScene(ProbeKind::phased);
  scene.media[0].sound_speed_m_s = 1800;  // the probe is in the slab: critical angle 60.7 degrees
  const Mesh slab = steepSlab(15, 0.08);  // met at 70 degrees and more
  for (const int line : {60, 64, 70}) EXPECT_LT(misplaced(scene, slab, line), 0.05) << line;
}

// The ball's edge stands in the cell of a line that misses it.
TEST(CellEchoes, OfATipThatNoCentreCrossesAreItsShare) {
  Scene scene = wallScene(ProbeKind::phased);
  scene.probe.lines = 33;
  scene.probe.samples = 256;
  const double width = (scene.probe.last_angle_rad - scene.probe.first_angle_rad) / 32;
  const int line = 20;
  // Its limb is seen 0.3 cells from the line's centre, on the side of lower numbers.
  const double limb = scene.probe.first_angle_rad + (line - 0.3) * width;
  const double radius = 0.03, depth = 0.09;
  const double middle = limb - std::asin(radius / depth);
  const Mesh ball =
      support::icosphere(6, radius).moved({depth * std::sin(middle), 0, depth * std::cos(middle)});
  const std::vector<float> centres = echoesOf(scene, ball, false);
  for (std::size_t k = 0; k < 256; ++k)
    ASSERT_EQ(centres[static_cast<std::size_t>(line) * 256 + k], 0);
  EXPECT_LT(misplaced(scene, ball, line), 0.1);
}

}  // namespace
}  // namespace echocine
