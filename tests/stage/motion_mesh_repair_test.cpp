// Nasty meshes: what each is refused with, and what its repair makes of it.

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/stage/nasty_meshes.h"

namespace echocine::motion_test {
namespace {

struct Case {
  std::string name;
  std::function<TriangleMesh()> make;
  std::string refused;  // part of the refusal without repair; empty: accepted
  Repairs repair;
  std::string done;        // what the repair says; starts with "!": the refusal after it
  double volume_of_balls;  // of the repaired mesh, in volumes of ball()
  double within = 1e-6;
};

std::vector<Case> cases() {
  const double octa = 4.0 / 3.0 / signedVolume(ball());  // of radius 1
  return {
      {"clean", ball, "", kAll, "", 1},
      {"inside out", [] { return flipped(ball(), 1); }, "repair = [\"orient\"]", kOrient,
       "512 faces turned", 1},
      {"partly flipped", [] { return flipped(ball(), 5); },
       "run their common edge (2, 0, 0) - (1.96157, 0.390181, 0) in the same direction; faces must "
       "be oriented consistently: reverse one of them, or set repair = [\"orient\"]",
       kOrient, "103 faces turned", 1},
      {"mostly flipped", [] { return flipped(flipped(ball(), 5), 1); }, "repair = [\"orient\"]",
       kOrient, "409 faces turned", 1},
      {"soup", [] { return soup(ball()); },
       "lids which close it, repair = [\"weld\"], or membrane = true", kWeld,
       "1278 vertices welded", 1},
      {"soup in single precision", [] { return shaken(soup(ball())); }, "repair = [\"weld\"]",
       kWeld, "1278 vertices welded", 1, 1e-5},
      {"flipped soup",
       [] { return flipped(soup(ball()), 3); },
       "repair = [\"weld\"]",
       {.weld = true, .orient = true},
       "1278 vertices welded, 171 faces turned",
       1},
      {"welded soup that is flipped", [] { return flipped(soup(ball()), 3); },
       "repair = [\"weld\"]", kWeld, "!repair = [\"orient\"]", 0},
      {"one face missing", [] { return without(ball(), 7, 1); }, "repair = [\"fill-holes\"]", kFill,
       "1 hole filled (1 face)", 1},
      {"a large hole", [] { return without(ball(), 0, 64); }, "one of 24;", kFill,
       "1 hole filled (24 faces)", 1 - 1.0 / 8 + 1 / (4 * std::numbers::pi), 0.002},
      {"half a ball", [] { return without(ball(), 0, 256); }, "one of 32;", kFill,
       "1 hole filled (32 faces)", 0.5},
      {"an eighth of a ball", [] { return without(ball(), 0, 448); }, "repair = [\"fill-holes\"]",
       kFill, "!would take 94 % of its surface to fill, 75 % is accepted", 0},
      {"a sheet", [] { return without(octahedron(2), 1, 7); }, "one of 3;", kFill,
       "!face 1: the open rim of 3 edges at this face would take 100 %", 0},
      {"a fin", [] { return finned(ball()); }, "face 514 has the same corners as a.obj: face 513",
       kDrop, "2 duplicate faces dropped, 1 unused vertex dropped", 1},
      {"a face twice", [] { return withFaces(ball(), {ball().triangles[4]}); },
       "face 513 has the same corners as a.obj: face 5: remove it, or set repair = "
       "[\"drop-degenerate\"]",
       kDrop, "1 duplicate face dropped", 1},
      {"a face twice, once reversed",
       [] {
         const Triangle t = ball().triangles[4];
         return withFaces(ball(), {{t[0], t[2], t[1]}});
       },
       "drop-degenerate", kDrop, "1 duplicate face dropped", 1},
      {"all faces twice", [] { return withFaces(ball(), ball().triangles); }, "drop-degenerate",
       kDrop, "512 duplicate faces dropped", 1},
      {"both sides of all faces", [] { return withFaces(ball(), flipped(ball(), 1).triangles); },
       "drop-degenerate", kDrop, "512 duplicate faces dropped", 1},
      {"a corner named twice",
       [] {
         return withFaces(ball(), {{3, 3, 5}});
       },
       "face 513 uses vertex 4 twice; remove the face, or set repair = [\"drop-degenerate\"]",
       kDrop, "1 face without area dropped", 1},
      {"flat face", [] { return withFlatFace(ball()); }, "", kDrop,
       "1 flat face repaired by flipping an edge", 1},
      {"needles", [] { return withNeedles(ball()); }, "", kDrop,
       "2 faces without area dropped, 1 unused vertex dropped", 1},
      {"three faces at an edge",
       [] {
         TriangleMesh mesh = ball();
         mesh.positions.push_back({3, 3, 3});
         const Triangle t = mesh.triangles[0];
         return withFaces(mesh, {{t[0], t[1], 258}});
       },
       "belongs to 3 faces, the last is a.obj: face 513; at most two are accepted: separate the "
       "surfaces that meet there, or set repair = [\"split\"]",
       kAll, "!belongs to 3 faces", 0},
      {"bow tie", bowTie, "meet in the point (2, 0, 0) only", kWeld,
       "1 vertex added where surfaces met in a point, 1 unused vertex dropped", 2 * 8 * octa},
      {"two parts",
       [] {
         return both(ball(), moved(ball(), {5, 0, 0}));
       },
       "", kAll, "", 2},
      {"two parts, one reversed",
       [] {
         return both(ball(), moved(flipped(octahedron(0.5), 1), {5, 0, 0}));
       },
       "face 513 and the 7 others of its separate surface look inward", kOrient, "8 faces turned",
       1 + octa / 8},
      {"parts that touch",
       [] {
         return both(ball(), moved(ball(), {4, 0, 0}));
       },
       "", kAll, "", 2},
      {"cavity", [] { return both(ball(), flipped(octahedron(0.5), 1)); }, "", kAll, "",
       1 - octa / 8},
      {"all of a shell reversed", [] { return both(flipped(ball(), 1), octahedron(0.5)); },
       "look inward", kOrient, "520 faces turned", 1 - octa / 8},
      {"island in a cavity, reversed",
       [] { return both(both(ball(), flipped(octahedron(1), 1)), flipped(octahedron(0.25), 1)); },
       "face 521 and the 7 others", kOrient, "8 faces turned", 1 - octa + octa / 64},
      {"vertex never used",
       [] {
         TriangleMesh mesh = ball();
         mesh.positions.insert(mesh.positions.begin(), Vec3d{0, 0, 0});
         for (Triangle& t : mesh.triangles)
           for (std::uint32_t& v : t) ++v;
         return mesh;
       },
       "", kWeld, "1 unused vertex dropped", 1},
      {"one side only", moebius, "run their common edge", kOrient, "!one side only", 0},
      {"not finite",
       [] {
         TriangleMesh mesh = ball();
         mesh.positions[9].y = std::nan("");
         return mesh;
       },
       "vertex 10 has a coordinate that is not finite; correct it", kAll, "!vertex 10", 0},
      {"a vertex that is not there",
       [] {
         return withFaces(ball(), {{0, 1, 999}});
       },
       "face 513 uses vertex 1000, the file has 258 vertices; correct the face", kAll,
       "!vertex 1000", 0},
      {"nothing but a fin",
       [] {
         TriangleMesh mesh = octahedron(2);
         mesh.triangles = {{0, 0, 2}};
         return mesh;
       },
       "uses vertex 1 twice", kDrop, "!no face is left", 0},
  };
}

TEST(MotionMeshRepair, EveryNastyMeshIsRefusedWithWhatToDoOrRepaired) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    std::vector<KeyframeMesh> raw = keyframesOf({c.make()}), mended = raw;
    const std::string refusal = errorOf([&] { mend(named({}), raw); });
    EXPECT_NE(refusal.find(c.refused.empty() ? "no error" : c.refused), std::string::npos)
        << refusal;
    EXPECT_EQ(refusal.find('\n'), std::string::npos);
    std::string note;
    const std::string after = errorOf([&] { note = mend(named(c.repair), mended); });
    if (c.done.starts_with('!')) {
      EXPECT_NE(after.find(c.done.substr(1)), std::string::npos) << after;
      continue;
    }
    EXPECT_EQ(after, "no error");
    if (after != "no error") continue;
    EXPECT_EQ(note, c.done.empty() ? "" : objPlace() + "repaired: " + c.done);
    const TriangleMesh& mesh = mended.front().mesh;
    EXPECT_EQ(leakCount(mesh.triangles), 0u);
    EXPECT_NEAR(signedVolume(mesh) / signedVolume(ball()), c.volume_of_balls, c.within);
  }
}

// Far from the surface they would steer the motion inside the body, and its extent.
TEST(MotionMeshRepair, VerticesWithoutAFaceAreNoPartOfTheSurface) {
  TriangleMesh stray = ball();
  stray.positions.insert(stray.positions.begin(), Vec3d{900, 0, 0});
  for (Triangle& t : stray.triangles)
    for (std::uint32_t& v : t) ++v;
  for (const Repairs& repair : {Repairs{}, kOrient, kFill, kWeld}) {
    std::vector<KeyframeMesh> keyframes = keyframesOf({stray, stray});
    keyframes[1].mesh.positions[0] = {-900, 0, 0};
    const std::string note = mend(named(repair), keyframes);
    EXPECT_EQ(note, repair.weld ? objPlace() + "repaired: 1 unused vertex dropped" : "");
    for (const KeyframeMesh& keyframe : keyframes) {
      EXPECT_EQ(keyframe.mesh.positions, ball().positions);
      EXPECT_EQ(keyframe.mesh.triangles, ball().triangles);
    }
  }
}

}  // namespace
}  // namespace echocine::motion_test
