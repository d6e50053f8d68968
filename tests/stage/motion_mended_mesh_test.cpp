// What a repair leaves as it was, and what of a mesh follows it: other keyframes, creases, numbers.

#include <algorithm>
#include <random>

#include "tests/stage/nasty_meshes.h"

namespace echocine::motion_test {
namespace {

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
