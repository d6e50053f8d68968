// Surfaces that meet each other, the imaging plane and the scan lines exactly: coincident,
// interpenetrating and touching walls, duplicate faces, slivers, points, facets in the plane.

#include <gtest/gtest.h>

#include "support/plain_scene.h"
#include "support/sweep.h"
#include "support/world.h"

namespace echocine {
namespace {

using namespace support;

// Structure i has medium i + 1.
World worldOf(const std::vector<Mesh>& meshes, const std::vector<int>& priorities) {
  World world{
      plainScene({medium("tissue", 1050, 1540, 5, 0.05), medium("muscle", 1060, 1580, 9, 0.1),
                  medium("blood", 1060, 1570, 1, 0.02)}),
      meshes};
  world.scene.effects.refraction = Switch::off;
  world.scene.probe.lines = 31;
  for (std::size_t s = 0; s < meshes.size(); ++s) addStructure(world.scene, s + 1, priorities[s]);
  return world;
}

double difference(const World& a, const World& b, Tracer tracer) {
  const std::vector<float> x = traceWorld(a, tracer).planes.at(Channel::y),
                           y = traceWorld(b, tracer).planes.at(Channel::y);
  double worst = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (x[i] != y[i])
      worst = std::max(worst, static_cast<double>(std::abs(x[i] - y[i]) / std::max(x[i], y[i])));
  return worst;
}

void expectSamePicture(const char* name, const char* oracle, const World& a, const World& b,
                       double bound = 1e-6) {
  Sweep sweep(name, oracle, kOfTracer, bound);
  for (const Tracer tracer : kTracers)
    sweep.addError(static_cast<double>(tracer), difference(a, b, tracer));
}

TEST(MeetingSurfaces, CoincidentWallsAreTheWallOfTheHigherPriority) {
  const Mesh ball = octasphere(3, 0.03).moved({0.002, 0, 0.08});
  World one = worldOf({ball, ball}, {1, 2}), alone = worldOf({ball}, {1});
  alone.scene.structures[0].medium = MediumId(2);
  expectSamePicture("coincident walls", "the one wall that wins", one, alone, 0);
}

// Two overlapping slabs are three that touch: overlap belongs to the higher priority.
// The oracle is the mesh cut by hand.
TEST(MeetingSurfaces, InterpenetratingWallsAreCutByPriority) {
  const Mesh first = box({-1, -1, 0.04}, {1, 1, 0.08}), second = box({-1, -1, 0.0625}, {1, 1, 0.1});
  const World overlapping = worldOf({first, second}, {1, 2});
  const World touching = worldOf({box({-1, -1, 0.04}, {1, 1, 0.0625}), second}, {1, 2});
  expectSamePicture("interpenetrating walls", "walls cut by hand", overlapping, touching);
}

TEST(MeetingSurfaces, DuplicateFacesAreNotSeen) {
  const Mesh ball = octasphere(3, 0.03).moved({0.002, 0, 0.08});
  Mesh doubled = ball;
  for (std::size_t t = 0; t < ball.triangles.size(); t += 3) {
    const auto [a, b, c] = ball.triangles[t];
    doubled.triangles.insert(doubled.triangles.end(), {{a, b, c}, {a, c, b}});  // a closed pair
  }
  Sweep sweep("duplicate faces: lines", "the mesh without them", kOfTracer, 0);
  for (const Tracer tracer : {Tracer::slice, Tracer::embree})
    sweep.addError(static_cast<double>(tracer),
                   difference(worldOf({ball}, {1}), worldOf({doubled}, {1}), tracer));
}

// A face cut by a point next to its edge, as close as a float can be: slivers beside large ones.
// Normals of slivers are the first thing that single precision loses.
TEST(MeetingSurfaces, SliversAreAsGoodAsTheFaceTheyArePartOf) {
  const Mesh whole = box({-0.03125, -0.0625, 0.0625}, {0.0390625, 0.03125, 0.09375});
  Sweep sweep("slivers in a flat face: lines", "the uncut face", "distance from the edge, 2^-31 m",
              1e-5);
  for (const double ulps : {1.0, 2.0, 16.0, 1e3, 1e5}) {
    Mesh cut = whole;
    // The front's diagonal runs from corner 1 to 2; a point beside its middle, within the face.
    const Vec3d middle = 0.5 * (whole.points[1] + whole.points[2]);
    cut.points.push_back(middle + Vec3d{ulps * 0x1p-31, ulps * 0x1p-31, 0});
    const auto m = static_cast<std::uint32_t>(cut.points.size() - 1);
    ASSERT_EQ(cut.triangles[1], (Triangle{1, 2, 3}));
    cut.triangles[1] = {1, 2, m};
    cut.triangles.insert(cut.triangles.end(), {{2, 3, m}, {3, 1, m}});
    for (const Tracer tracer : {Tracer::slice, Tracer::embree})
      sweep.addError(ulps, difference(worldOf({whole}, {1}), worldOf({cut}, {1}), tracer));
  }
}

// Triangles of several surfaces shrunk to one point: Embree's builder used to end the program.
TEST(MeetingSurfaces, TrianglesOfSeveralMeshesShrunkToOnePoint) {
  Mesh ball = octasphere(3, 0.03).moved({0.002, 0, 0.08});
  for (Vec3d& p : ball.points)
    if (p.z > 0.085) p = {0.002, 0, 0.085};
  Mesh shrunk = ball;
  for (Vec3d& p : shrunk.points) p = {0.002, 0, 0.085};
  World alone = worldOf({ball}, {1});
  alone.scene.structures[0].medium = MediumId(2);
  expectSamePicture("zero-area: two meshes shrunk in part to one point", "the one wall that wins",
                    worldOf({ball, ball}, {1, 2}), alone, 0);
  expectSamePicture("zero-area: a mesh shrunk to a point of another", "the other alone",
                    worldOf({ball, shrunk}, {1, 2}), worldOf({ball}, {1}), 0);
  expectSamePicture("zero-area: two meshes shrunk to a point", "no meshes",
                    worldOf({shrunk, shrunk}, {1, 2}), worldOf({}, {}), 0);
}

// Faces exactly in the imaging plane: the box is as one moved by a nanometre to the one side or to
// the other: what lies in the plane counts as above it.
TEST(MeetingSurfaces, FacesInTheImagingPlaneBelongToOneSideOfIt) {
  const auto boxFrom = [](double y0, double y1) {
    return worldOf({box({-0.03, y0, 0.05}, {0.03, y1, 0.09})}, {1});
  };
  const double nm = 1e-9;
  expectSamePicture("whole facets in the plane, box above", "box moved by 1 nm", boxFrom(0, 0.02),
                    boxFrom(nm, 0.02));
  expectSamePicture("whole facets in the plane, box below", "box moved by 1 nm", boxFrom(-0.02, 0),
                    boxFrom(-0.02, nm));
}

// A linear probe's line in the side of a box and its float neighbours: hit or miss, never between.
TEST(MeetingSurfaces, ALineInTheSideOfABoxHitsOrMissesIt) {
  Sweep sweep("ray exactly tangent to a face", "box moved by 1 um",
              "distance from the face, 2^-30 m", 1e-6);
  const auto boxTo = [](double side) {
    World world = worldOf({box({-0.03, -0.02, 0.05}, {side, 0.02, 0.09})}, {1});
    Probe& probe = world.scene.probe;
    probe.kind = ProbeKind::linear;
    probe.first_angle_rad = probe.last_angle_rad = 0;
    probe.first_offset_m = -0.015625;
    probe.last_offset_m = 0.015625;
    probe.lines = 33;  // one of them at 0.0078125
    return world;
  };
  const World hit = boxTo(0.0078125 + 1e-6), miss = boxTo(0.0078125 - 1e-6);
  for (int ulps = -3; ulps <= 3; ++ulps) {
    const World world = boxTo(0.0078125 + ulps * 0x1p-30);
    for (const Tracer tracer : {Tracer::slice, Tracer::embree}) {
      const double of_hit = difference(world, hit, tracer),
                   of_miss = difference(world, miss, tracer);
      sweep.addError(ulps, ulps > 0 ? of_hit : ulps < 0 ? of_miss : std::min(of_hit, of_miss));
    }
  }
}

}  // namespace
}  // namespace echocine
