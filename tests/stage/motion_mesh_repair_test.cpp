// Nasty meshes: what each is refused with, and what its repair makes of it.

#include "motion/repair/mesh_repair.h"

#include <algorithm>
#include <functional>
#include <random>

#include "motion/mesh/mesh_check.h"
#include "tests/stage/motion_fixtures.h"

namespace echocine::motion_test {
namespace {

// --- makers of nastiness, all from a ball of 512 faces -------------------------------------------

TriangleMesh ball() {
  return sphere(2, 3);
}

TriangleMesh flipped(TriangleMesh mesh, std::size_t every) {
  for (std::size_t t = 0; t < mesh.triangles.size(); t += every)
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  return mesh;
}

TriangleMesh soup(const TriangleMesh& mesh) {
  TriangleMesh out;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) out.positions.push_back(mesh.positions[v]);
    const auto last = static_cast<std::uint32_t>(out.positions.size());
    out.triangles.push_back({last - 3, last - 2, last - 1});
  }
  return out;
}

// Every place computed a little differently, as single precision does.
TriangleMesh shaken(TriangleMesh mesh) {
  std::mt19937 random(3);
  for (Vec3d& p : mesh.positions)
    for (double* c : {&p.x, &p.y, &p.z})
      *c += (static_cast<double>(random() % 3) - 1) * 2.0 / (1 << 23);
  return mesh;
}

TriangleMesh without(TriangleMesh mesh, std::size_t first, std::size_t count) {
  const auto begin = mesh.triangles.begin() + static_cast<std::ptrdiff_t>(first);
  mesh.triangles.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
  return mesh;
}

TriangleMesh withFaces(TriangleMesh mesh, const std::vector<Triangle>& faces) {
  mesh.triangles.insert(mesh.triangles.end(), faces.begin(), faces.end());
  return mesh;
}

TriangleMesh both(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh out = a;
  const auto offset = static_cast<std::uint32_t>(a.positions.size());
  out.positions.insert(out.positions.end(), b.positions.begin(), b.positions.end());
  for (const Triangle& t : b.triangles)
    out.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return out;
}

TriangleMesh moved(TriangleMesh mesh, Vec3d by) {
  for (Vec3d& p : mesh.positions) p = p + by;
  return mesh;
}

// A fin on edge (a, b) of the first face: one triangle with both its sides.
TriangleMesh finned(TriangleMesh mesh) {
  const auto tip = static_cast<std::uint32_t>(mesh.positions.size());
  const Triangle t = mesh.triangles[0];
  mesh.positions.push_back(1.5 * mesh.positions[t[0]]);
  return withFaces(mesh, {{t[0], t[1], tip}, {t[1], t[0], tip}});
}

// Edge (a, b) of the first face is cut at its middle, in that face only: the other side keeps it,
// and a face without area stands between both.
TriangleMesh withFlatFace(TriangleMesh mesh) {
  const auto middle = static_cast<std::uint32_t>(mesh.positions.size());
  const Triangle t = mesh.triangles[0];
  mesh.positions.push_back(0.5 * (mesh.positions[t[0]] + mesh.positions[t[1]]));
  mesh.triangles[0] = {t[0], middle, t[2]};
  return withFaces(mesh, {{middle, t[1], t[2]}, {t[0], t[1], middle}});
}

// Vertex a of the first face is doubled: its fan is cut open there and the slit filled with faces
// without area.
TriangleMesh withNeedles(TriangleMesh mesh) {
  const std::uint32_t a = mesh.triangles[0][0];
  const auto twin = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back(Vec3d{mesh.positions[a]});
  Triangle& t = mesh.triangles[0];
  const std::uint32_t b = t[1], c = t[2];
  t = {twin, b, c};
  return withFaces(mesh, {{a, b, twin}, {twin, c, a}});
}

// Two balls that share one vertex.
TriangleMesh bowTie() {
  TriangleMesh two = both(octahedron(2), octahedron(2, {4, 0, 0}));
  for (Triangle& t : two.triangles)
    for (std::uint32_t& v : t)
      if (v == 7) v = 0;  // (2, 0, 0) of both
  return two;
}

TriangleMesh moebius() {
  TriangleMesh strip;
  constexpr std::uint32_t n = 12;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double turn = 2 * std::numbers::pi * i / n;
    for (const double side : {-0.5, 0.5})
      strip.positions.push_back({(2 + side * std::cos(turn / 2)) * std::cos(turn),
                                 (2 + side * std::cos(turn / 2)) * std::sin(turn),
                                 side * std::sin(turn / 2)});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1;
    const std::uint32_t c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0;
    strip.triangles.insert(strip.triangles.end(), {{a, b, c}, {b, d, c}});
  }
  return strip;
}

// --- the table -----------------------------------------------------------------------------------

constexpr Repairs kWeld{.weld = true}, kDrop{.drop_degenerate = true}, kOrient{.orient = true},
    kFill{.fill_holes = true},
    kAll{.weld = true, .drop_degenerate = true, .orient = true, .fill_holes = true};

struct Case {
  std::string name;
  std::function<TriangleMesh()> make;
  std::string refused;  // part of the refusal without repair; empty: accepted
  Repairs repair;
  std::string done;        // what the repair says; starts with "!": the refusal after it
  double volume_of_balls;  // of the repaired mesh, in volumes of ball()
  double within = 1e-6;
};

std::string objPlace() {
  return "scene.toml:7: structure.keyframes: ball: ";
}

std::vector<Case> cases() {
  const double octa = 4.0 / 3.0 / signedVolume(ball());  // of radius 1
  return {
      {"clean", ball, "", kAll, "", 1},
      {"inside out", [] { return flipped(ball(), 1); }, "repair = [\"orient\"]", kOrient,
       "512 faces turned", 1},
      {"partly flipped", [] { return flipped(ball(), 5); },
       "run their common edge (2, 0, 0) - (1.96157, 0.390181, 0) in the same direction; faces must "
       "be oriented alike: reverse one of them, or set repair = [\"orient\"]",
       kOrient, "103 faces turned", 1},
      {"mostly flipped", [] { return flipped(flipped(ball(), 5), 1); }, "repair = [\"orient\"]",
       kOrient, "409 faces turned", 1},
      {"soup", [] { return soup(ball()); },
       "repair = [\"weld\"], as vertices lie at the same places", kWeld, "1278 vertices welded", 1},
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
       "1 flat face mended by turning an edge", 1},
      {"needles", [] { return withNeedles(ball()); }, "", kDrop,
       "2 faces without area dropped, 1 unused vertex dropped", 1},
      {"three faces at an edge",
       [] {
         TriangleMesh mesh = ball();
         mesh.positions.push_back({3, 3, 3});
         const Triangle t = mesh.triangles[0];
         return withFaces(mesh, {{t[0], t[1], 258}});
       },
       "belongs to 3 faces, the last is a.obj: face 513; at most two are accepted: split surfaces",
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
       "vertex 10 has a coordinate that is not finite; mend it", kAll, "!vertex 10", 0},
      {"a vertex that is not there",
       [] {
         return withFaces(ball(), {{0, 1, 999}});
       },
       "face 513 uses vertex 1000, the file has 258 vertices; mend the face", kAll, "!vertex 1000",
       0},
      {"nothing but a fin",
       [] {
         TriangleMesh mesh = octahedron(2);
         mesh.triangles = {{0, 0, 2}};
         return mesh;
       },
       "uses vertex 1 twice", kDrop, "!no face is left", 0},
  };
}

Structure named(const Repairs& repair, bool membrane = false) {
  Structure structure = structureOf({});
  structure.repair = repair;
  structure.membrane = membrane;
  return structure;
}

// Reads nothing: the same checks and repairs as MeshMotion's, on meshes in memory.
std::string mend(const Structure& structure, std::vector<KeyframeMesh>& keyframes) {
  for (const KeyframeMesh& keyframe : keyframes)
    checkFile(keyframe.mesh, keyframe.parts.front().file, structure.repair.drop_degenerate);
  const std::string note = repairKeyframes(structure, keyframes);
  checkKeyframes(structure, keyframes, 0.01);
  return note;
}

std::vector<KeyframeMesh> keyframesOf(const std::vector<TriangleMesh>& meshes) {
  std::vector<KeyframeMesh> keyframes;
  for (const TriangleMesh& mesh : meshes)
    keyframes.push_back(
        {mesh, {{std::string(1, static_cast<char>('a' + keyframes.size())) + ".obj"}}});
  return keyframes;
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

TEST(MotionMeshRepair, ACleanMeshStaysToTheLastBit) {
  std::vector<KeyframeMesh> keyframes = keyframesOf({ball(), sphere(1.5, 3)});
  const std::vector<KeyframeMesh> before = keyframes;
  EXPECT_EQ(mend(named(kAll), keyframes), "");
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(keyframes[k].mesh.positions, before[k].mesh.positions);
    EXPECT_EQ(keyframes[k].mesh.triangles, before[k].mesh.triangles);
  }
}

TEST(MotionMeshRepair, ATurnedBallIsTheBallItself) {
  std::vector<KeyframeMesh> keyframes = keyframesOf({flipped(ball(), 1)});
  mend(named(kAll), keyframes);
  EXPECT_EQ(keyframes.front().mesh.triangles, ball().triangles);
}

TEST(MotionMeshRepair, KeyframesAreRepairedAlike) {
  TriangleMesh larger = soup(sphere(2.5, 3));
  std::vector<KeyframeMesh> keyframes =
      keyframesOf({without(flipped(soup(ball()), 3), 0, 64), without(flipped(larger, 3), 0, 64)});
  EXPECT_EQ(mend(named(kAll), keyframes),
            objPlace() +
                "repaired: 1107 vertices welded, 192 unused vertices dropped, 149 faces turned, 1 "
                "hole filled (24 faces)");
  EXPECT_EQ(keyframes[0].mesh.triangles, keyframes[1].mesh.triangles);
  EXPECT_NEAR(signedVolume(keyframes[1].mesh) / signedVolume(keyframes[0].mesh),
              std::pow(2.5 / 2, 3), 1e-9);
}

TEST(MotionMeshRepair, WhatPartsLaterIsNotWelded) {
  // Two balls that touch in a point in the first keyframe only, as soups.
  const TriangleMesh touching = soup(both(octahedron(2), octahedron(2, {4, 0, 0})));
  const TriangleMesh apart = soup(both(octahedron(2), octahedron(2, {4.5, 0, 0})));
  std::vector<KeyframeMesh> keyframes = keyframesOf({touching, apart});
  EXPECT_EQ(mend(named(kWeld), keyframes), objPlace() + "repaired: 36 vertices welded");
  EXPECT_EQ(keyframes[1].mesh.positions.size(), 12u);
}

TEST(MotionMeshRepair, OtherFacesInALaterKeyframeAreRefusedBeforeAnythingIsDone) {
  std::vector<KeyframeMesh> keyframes = keyframesOf({soup(ball()), without(soup(ball()), 0, 1)});
  EXPECT_EQ(errorOf([&] { mend(named(kWeld), keyframes); }),
            objPlace() + "b.obj has 511 faces, a.obj has 512; every keyframe must have the same");
}

TEST(MotionMeshRepair, ALaterKeyframeInsideOutIsStillRefused) {
  TriangleMesh mirrored = ball();
  for (Vec3d& p : mirrored.positions) p.x = -p.x;
  std::vector<KeyframeMesh> keyframes = keyframesOf({ball(), mirrored});
  EXPECT_NE(errorOf([&] { mend(named(kAll), keyframes); }).find("b.obj encloses a volume of -"),
            std::string::npos);
}

TEST(MotionMeshRepair, TheOrderOfVerticesAndFacesChangesNothingButRounding) {
  TriangleMesh nasty = without(flipped(soup(ball()), 3), 0, 64);
  std::vector<KeyframeMesh> plain = keyframesOf({nasty});
  const std::string note = mend(named(kAll), plain);
  std::mt19937 random(7);
  std::vector<std::uint32_t> place(nasty.positions.size());
  for (std::uint32_t v = 0; v < place.size(); ++v) place[v] = v;
  std::shuffle(place.begin(), place.end(), random);
  TriangleMesh mixed = nasty;
  for (std::size_t v = 0; v < place.size(); ++v) mixed.positions[place[v]] = nasty.positions[v];
  for (Triangle& t : mixed.triangles)
    for (std::uint32_t& v : t) v = place[v];
  std::shuffle(mixed.triangles.begin(), mixed.triangles.end(), random);
  std::vector<KeyframeMesh> other = keyframesOf({mixed});
  EXPECT_EQ(mend(named(kAll), other), note);
  EXPECT_NEAR(signedVolume(other.front().mesh), signedVolume(plain.front().mesh), 1e-9);
  EXPECT_EQ(other.front().mesh.positions.size(), plain.front().mesh.positions.size());
}

TEST(MotionMeshRepair, MembranesAreWeldedAndOrientedButStayOpen) {
  const TriangleMesh sheet = without(ball(), 0, 256);
  std::vector<KeyframeMesh> keyframes = keyframesOf({flipped(soup(sheet), 3)});
  EXPECT_EQ(mend(named({.weld = true, .drop_degenerate = true, .orient = true}, true), keyframes),
            objPlace() + "repaired: 623 vertices welded, 86 faces turned");
  EXPECT_EQ(leakCount(keyframes.front().mesh.triangles), 32u);
}

TEST(MotionMeshRepair, FacesKeepTheNumbersOfTheirFile) {
  // The first face collapsed: what is wrong with the file's face 4 is said of face 4.
  TriangleMesh mesh = withFaces({}, {{1, 1, 2}});
  const TriangleMesh octa = octahedron(2);
  mesh.positions = octa.positions;
  mesh = withFaces(mesh, octa.triangles);
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  std::vector<KeyframeMesh> keyframes = keyframesOf({mesh});
  const std::string error = errorOf([&] { mend(named(kDrop), keyframes); });
  EXPECT_NE(error.find("a.obj: face 4 and a.obj: face 8 run"), std::string::npos) << error;
}

TEST(MotionMeshRepair, CreasesFollowTheirEdges) {
  TriangleMesh nasty = soup(octahedron(2));
  nasty.tags.edges = {{0, 1, 3}};  // of the first face
  nasty.tags.vertices = {{2, 5}};  // its last corner
  std::vector<KeyframeMesh> keyframes = keyframesOf({nasty, nasty});
  mend(named(kAll), keyframes);
  const TriangleMesh& mesh = keyframes[1].mesh;
  ASSERT_EQ(mesh.tags.edges.size(), 1u);
  EXPECT_EQ(mesh.positions[mesh.tags.edges[0].v0], (Vec3d{2, 0, 0}));
  EXPECT_EQ(mesh.positions[mesh.tags.edges[0].v1], (Vec3d{0, 2, 0}));
  ASSERT_EQ(mesh.tags.vertices.size(), 1u);
  EXPECT_EQ(mesh.positions[mesh.tags.vertices[0].v], (Vec3d{0, 0, 2}));
}

TEST(MotionMeshRepair, CreasesThatCannotFollowAreNamed) {
  TriangleMesh lost = finned(octahedron(2));
  lost.tags.edges = {{0, 6, 3}};  // of the fin
  std::vector<KeyframeMesh> keyframes = keyframesOf({lost});
  EXPECT_EQ(errorOf([&] { mend(named(kDrop), keyframes); }),
            objPlace() +
                "crease 0 - 6 (vertices count from 0 in tags) loses its edge in the repair: remove "
                "the tag or the repair");
  TriangleMesh unequal = soup(octahedron(2));
  unequal.tags.vertices = {{0, 3}, {10, 4}};  // (2, 0, 0) in faces 1 and 4
  keyframes = keyframesOf({unequal});
  EXPECT_NE(errorOf([&] { mend(named(kWeld), keyframes); }).find("another sharpness"),
            std::string::npos);
}

// Damage of every kind at once ends as a whole surface or in one line, never in a crash.
TEST(MotionMeshRepair, RandomDamageIsRepairedOrRefused) {
  std::mt19937 random(11);
  int repaired = 0;
  for (int round = 0; round < 200; ++round) {
    TriangleMesh mesh = round % 2 ? soup(sphere(2, 2)) : sphere(2, 2);
    for (int damage = 0; damage < 6; ++damage) {
      const std::size_t t = random() % mesh.triangles.size();
      const auto v = static_cast<std::uint32_t>(random() % mesh.positions.size());
      switch (random() % 6) {
        case 0:
          mesh = without(mesh, t, 1);
          break;
        case 1:
          mesh.triangles.push_back(Triangle{mesh.triangles[t]});
          break;
        case 2:
          std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
          break;
        case 3:
          mesh.triangles.push_back({v, v, mesh.triangles[t][0]});
          break;
        case 4:
          mesh.triangles[t][random() % 3] = v;
          break;
        default:
          mesh.positions[v] = Vec3d{mesh.positions[mesh.triangles[t][0]]};
          break;
      }
    }
    std::vector<KeyframeMesh> keyframes = keyframesOf({mesh});
    const std::string error = errorOf([&] { mend(named(kAll), keyframes); });
    EXPECT_EQ(error.find('\n'), std::string::npos);
    if (error != "no error") continue;
    ++repaired;
    EXPECT_EQ(leakCount(keyframes.front().mesh.triangles), 0u);
    EXPECT_GT(signedVolume(keyframes.front().mesh), 0);
  }
  EXPECT_GT(repaired, 40);
}

}  // namespace
}  // namespace echocine::motion_test
