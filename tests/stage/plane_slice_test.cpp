// The plane slice: the same crossings as the hierarchy, to the last bit, and contours that close.

#include <gtest/gtest.h>

#include "scene/scan_geometry.h"
#include "support/plain_scene.h"
#include "support/surfaces.h"
#include "truth/contour.h"

namespace echocine {
namespace {

using support::Mesh;

Probe probeOf(ProbeKind kind, int lines) {
  Probe probe = support::plainScene({support::medium("m", 1000, 1500)}).probe;
  probe.kind = kind;
  probe.lines = lines;
  if (kind == ProbeKind::curvilinear) probe.face_radius_m = 0.03;
  if (kind == ProbeKind::linear) {
    probe.first_angle_rad = probe.last_angle_rad = 0;
    probe.first_offset_m = -0.04;
    probe.last_offset_m = 0.04;
  }
  return probe;
}

struct Slices {
  std::vector<SurfaceTopology> topology;
  SurfaceFrame frame;

  void add(const Mesh& mesh, bool membrane = false) {
    topology.push_back({SurfaceId{static_cast<std::uint32_t>(topology.size())}, mesh.triangles,
                        static_cast<std::uint32_t>(mesh.points.size()), membrane, false});
    frame.positions_m.emplace_back();
    for (const Vec3d& p : mesh.points) frame.positions_m.back().push_back(toFloat(p));
  }
};

void expectSameCrossings(const Slices& s, const Probe& probe) {
  PlaneSlice slice(s.topology, probe);
  slice.update(s.frame);
  FrameGeometry geometry(s.topology);
  geometry.update(s.frame);
  for (int i = 0; i < probe.lines; ++i) {
    const LineGeometry line = lineGeometry(probe, i);
    const std::vector<RayQuery> query{
        {{line.origin, line.direction}, geometry.insideAt(line.origin), {}}};
    std::vector<RayCrossings> met(1);
    geometry.crossings(query, met);
    const RayCrossings& sliced = slice.lines()[static_cast<std::size_t>(i)];
    ASSERT_EQ(sliced.inside, met[0].inside) << "line " << i;
    ASSERT_EQ(sliced.crossings.size(), met[0].crossings.size()) << "line " << i;
    for (std::size_t c = 0; c < sliced.crossings.size(); ++c) {
      const Crossing &a = sliced.crossings[c], &b = met[0].crossings[c];
      ASSERT_EQ(a.distance_m, b.distance_m) << "line " << i << " crossing " << c;
      ASSERT_EQ(a.triangle, b.triangle);
      ASSERT_EQ(a.surface, b.surface);
      ASSERT_EQ(a.entering, b.entering);
      ASSERT_TRUE(a.normal == b.normal);
    }
  }
}

TEST(PlaneSlice, MeetsWhatTheHierarchyMeetsForEveryProbeKind) {
  Slices s;
  s.add(support::icosphere(4, 0.03).moved({0.004, 0.002, 0.08}));
  s.add(support::icosphere(4, 0.02).moved({0.006, 0.001, 0.08}));
  s.add(support::sheet(9, 0.025, 0.12), true);
  for (const ProbeKind kind : {ProbeKind::phased, ProbeKind::curvilinear, ProbeKind::linear})
    expectSameCrossings(s, probeOf(kind, 255));
}

// A heart meshed symmetrically about the imaging plane has this everywhere.
TEST(PlaneSlice, VerticesAndEdgesOnThePlaneAndOnScanLinesAreMetOnce) {
  // The octahedral and the UV sphere have whole edges in y = 0 and vertices on x = 0; 255 lines
  // include 0 degrees.
  Slices s;
  s.add(support::octasphere(4, 0.03).moved({0, 0, 0.08}));
  s.add(support::uvSphere(24, 32, 0.02).moved({0, 0, 0.08}));
  s.add(support::sheet(8, 0.025, 0.13), true);
  for (const ProbeKind kind : {ProbeKind::phased, ProbeKind::curvilinear, ProbeKind::linear}) {
    const Probe probe = probeOf(kind, 255);
    expectSameCrossings(s, probe);
    PlaneSlice slice(s.topology, probe);
    slice.update(s.frame);
    EXPECT_EQ(slice.lines()[127].crossings.size(), 5u);  // two spheres and the sheet, straight down
  }
}

// Decided by rule (y >= 0 is above), never by a tolerance.
TEST(PlaneSlice, WholeFacetsInThePlaneLeaveAClosedContour) {
  Slices s;
  s.add(support::box({-0.02, 0, 0.05}, {0.02, 0.02, 0.09}));   // a face in y = 0, seen from above
  s.add(support::box({-0.01, -0.02, 0.06}, {0.01, 0, 0.08}));  // a face in y = 0, from below
  expectSameCrossings(s, probeOf(ProbeKind::phased, 101));
}

TEST(PlaneSlice, ProbeInsideAStructureIsKnownFromTheContourAlone) {
  Slices s;
  s.add(support::icosphere(3, 0.05).moved({0.001, 0.002, 0.003}));
  const Probe probe = probeOf(ProbeKind::phased, 64);
  expectSameCrossings(s, probe);
  PlaneSlice slice(s.topology, probe);
  slice.update(s.frame);
  for (const RayCrossings& line : slice.lines()) {
    EXPECT_TRUE(line.inside[0]);
    EXPECT_EQ(line.crossings.size(), 1u);
  }
}

TEST(PlaneSlice, SectorOfHalfATurnAndPiecesBehindTheProbe) {
  Slices s;
  s.add(support::icosphere(3, 0.05).moved({0.01, 0.002, 0.01}));
  Probe probe = probeOf(ProbeKind::phased, 181);
  probe.first_angle_rad = -std::numbers::pi / 2;
  probe.last_angle_rad = std::numbers::pi / 2;
  expectSameCrossings(s, probe);
}

// What does not move is not cut again: the cut must be that of the first frame.
TEST(PlaneSlice, StillSurfacesAreCutOnceAndStayMet) {
  Slices s;
  s.add(support::icosphere(3, 0.03).moved({0, 0.001, 0.08}));
  s.topology[0].still = true;
  PlaneSlice slice(s.topology, probeOf(ProbeKind::phased, 33));
  slice.update(s.frame);
  const std::size_t edges = slice.edges().size();
  slice.update(s.frame);
  EXPECT_EQ(slice.edges().size(), edges);
  EXPECT_EQ(slice.lines()[16].crossings.size(), 2u);
}

TEST(PlaneSlice, LeftOutSurfacesAreMetByNeitherTracer) {
  Slices s;
  s.add(support::icosphere(3, 0.03).moved({0, 0.001, 0.08}));
  s.add(support::icosphere(3, 0.02).moved({0, 0.001, 0.08}));
  SurfaceSet left_out;
  left_out[0] = true;
  const Probe probe = probeOf(ProbeKind::phased, 33);
  PlaneSlice slice(s.topology, probe, left_out);
  slice.update(s.frame);
  FrameGeometry geometry(s.topology, left_out);
  geometry.update(s.frame);
  const std::vector<RayQuery> query{{support::kDepthwards, {}, {}}};
  std::vector<RayCrossings> met(1);
  geometry.crossings(query, met);
  for (const RayCrossings* line :
       std::initializer_list<const RayCrossings*>{&slice.lines()[16], &met[0]}) {
    ASSERT_EQ(line->crossings.size(), 2u);
    EXPECT_EQ(index(line->crossings[0].surface), 1u);
  }
}

TEST(Contours, OfASphereIsOneClosedCircle) {
  Slices s;
  s.add(support::icosphere(4, 0.03).moved({0.001, 0.0007, 0.08}));
  PlaneSlice slice(s.topology, probeOf(ProbeKind::phased, 8));
  slice.update(s.frame);
  const std::vector<Contour> contours = chainContours(slice.edges(), s.topology, s.frame);
  ASSERT_EQ(contours.size(), 1u);
  EXPECT_TRUE(contours[0].closed);
  EXPECT_EQ(contours[0].points_m.size(), slice.edges().size());
  double twice_area = 0;
  for (std::size_t i = 0; i < contours[0].points_m.size(); ++i) {
    const Vec3d a = contours[0].points_m[i],
                b = contours[0].points_m[(i + 1) % contours[0].points_m.size()];
    EXPECT_EQ(a.y, 0);
    twice_area += a.x * b.z - a.z * b.x;
  }
  const double radius2 = 0.03 * 0.03 - 0.0007 * 0.0007;
  EXPECT_NEAR(std::abs(twice_area) / 2, std::numbers::pi * radius2,
              0.01 * std::numbers::pi * radius2);
}

TEST(Contours, OfAnOpenSheetIsOneOpenChain) {
  Slices s;
  s.add(support::sheet(8, 0.02, 0.1), true);
  PlaneSlice slice(s.topology, probeOf(ProbeKind::phased, 8));
  slice.update(s.frame);
  const std::vector<Contour> contours = chainContours(slice.edges(), s.topology, s.frame);
  ASSERT_EQ(contours.size(), 1u);
  EXPECT_FALSE(contours[0].closed);
  EXPECT_EQ(contours[0].points_m.size(), slice.edges().size() + 1);
}

}  // namespace
}  // namespace echocine
