// Edges of three, four and more faces: parted into sheets that close, alike in all keyframes.

#include <array>

#include "motion/mesh/edge_sides.h"
#include "tests/stage/nasty_meshes.h"

namespace echocine::motion_test {
namespace {

constexpr Repairs kSplit{.split = true}, kSplitOrient{.orient = true, .split = true};

// The mesh with the vertices of `from` put in place of those of `to`, one by one.
TriangleMesh glued(TriangleMesh mesh, const std::vector<std::uint32_t>& from,
                   const std::vector<std::uint32_t>& to) {
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t)
      for (std::size_t i = 0; i < from.size(); ++i)
        if (v == to[i]) v = from[i];
  return mesh;
}

// A cube of side 2 about a place, each side two triangles.
TriangleMesh cube(Vec3d centre) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.positions.push_back(centre +
                             Vec3d{i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
  for (const auto& [a, b, c, d] : std::vector<std::array<std::uint32_t, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  return mesh;
}

// Two cubes of volume 8 that share the edge at (1, 1, z).
TriangleMesh cubesAtAnEdge() {
  return glued(both(cube({}), cube({2, 2, 0})), {3, 7}, {8, 12});
}

// Three cubes about the same edge.
TriangleMesh threeWedges() {
  TriangleMesh all;
  for (int i = 0; i < 3; ++i) {
    const double turn = 2 * std::numbers::pi * i / 3;
    TriangleMesh wedge = cube({1, 1, 0});
    for (Vec3d& p : wedge.positions) {
      // A cube's edge at the origin, drawn into a wedge of 90 degrees; turned about it.
      p = {std::cos(turn) * p.x - std::sin(turn) * p.y, std::sin(turn) * p.x + std::cos(turn) * p.y,
           p.z};
    }
    all = i == 0 ? wedge : both(all, wedge);
  }
  return glued(all, {0, 4, 0, 4}, {8, 12, 16, 20});
}

// Two chambers with a wall between them: the triangles of the wall are there once.
TriangleMesh twoChambers() {
  TriangleMesh mesh = glued(both(cube({}), cube({2, 0, 0})), {1, 3, 5, 7}, {8, 10, 12, 14});
  // The second cube's side at x = 1 is {0, 4, 6, 2} of it: its triangles 8 and 9.
  return without(mesh, 12 + 8, 2);
}

struct Planted {
  const char* name;
  TriangleMesh mesh;
  Repairs repair;
  double volume;
  std::size_t pieces;
};

std::vector<Planted> planted() {
  TriangleMesh flap = ball();
  flap.positions.push_back({3, 3, 3});
  const Triangle t = flap.triangles[0];
  flap = withFaces(flap, {{t[0], t[1], 258}});
  TriangleMesh chord = ball();  // over vertices that are there already
  chord = withFaces(chord, {{t[0], t[1], 200}});
  const double whole = signedVolume(ball());
  return {
      {"a flap", flap, kSplit, whole, 1},
      {"a triangle across the inside", chord, kSplit, whole, 1},
      {"two cubes at an edge", cubesAtAnEdge(), kSplit, 16, 2},
      {"two cubes at an edge, partly flipped", flipped(cubesAtAnEdge(), 3), kSplitOrient, 16, 2},
      {"three wedges at an edge", threeWedges(), kSplit, 24, 3},
      {"two chambers and their wall", twoChambers(), kSplit, 16, 1},
      {"two balls at a vertex", bowTie(), kSplit, 2 * 8 * 4.0 / 3.0, 2}};
}

std::size_t pieceCount(const TriangleMesh& mesh) {
  return piecesOf(oppositeSides(mesh.triangles, sortedSides(mesh.triangles))).count;
}

TEST(MotionSplit, PlantedEdgesCloseAndKeepTheirVolume) {
  for (const Planted& c : planted()) {
    SCOPED_TRACE(c.name);
    std::vector<KeyframeMesh> keyframes = keyframesOf({c.mesh});
    EXPECT_NE(errorOf([&] {
                std::vector<KeyframeMesh> raw = keyframes;
                mend(named({}), raw);
              }),
              "no error");
    EXPECT_EQ(errorOf([&] { mend(named(c.repair), keyframes); }), "no error");
    const TriangleMesh& mesh = keyframes.front().mesh;
    EXPECT_EQ(leakCount(mesh.triangles), 0u);
    EXPECT_NEAR(signedVolume(mesh), c.volume, 1e-9 * c.volume);
    EXPECT_EQ(pieceCount(mesh), c.pieces);
  }
}

TEST(MotionSplit, WhatWasDoneIsSaid) {
  std::vector<KeyframeMesh> keyframes = keyframesOf({cubesAtAnEdge()});
  EXPECT_EQ(mend(named(kSplit), keyframes),
            objPlace() +
                "repaired: 1 edge of more than two faces split, 2 vertices added where sheets were "
                "separated, 2 unused vertices dropped");
}

// The second keyframe alone would be paired otherwise: the cubes stand turned into each other.
TEST(MotionSplit, KeyframesArePartedAlike) {
  TriangleMesh later = cubesAtAnEdge();
  for (Vec3d& p : later.positions) p = {0.8 * p.x, 0.9 * p.y + 0.1 * p.x, 1.1 * p.z};
  std::vector<KeyframeMesh> keyframes = keyframesOf({cubesAtAnEdge(), later});
  mend(named(kSplit), keyframes);
  EXPECT_EQ(keyframes[0].mesh.triangles, keyframes[1].mesh.triangles);
  EXPECT_EQ(keyframes[0].mesh.positions.size(), keyframes[1].mesh.positions.size());
  EXPECT_NEAR(signedVolume(keyframes[1].mesh), 16 * 0.8 * 0.9 * 1.1, 1e-9);
}

TEST(MotionSplit, OfAMembraneNothingIsDropped) {
  TriangleMesh leaflets{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}},
                        {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}};
  std::vector<KeyframeMesh> keyframes = keyframesOf({leaflets});
  mend(named(kSplit, true), keyframes);
  EXPECT_EQ(keyframes.front().mesh.triangles.size(), 3u);
}

TEST(MotionSplit, AMembraneMayWindAsItLikes) {
  const TriangleMesh sheet = without(ball(), 0, 256);
  std::vector<KeyframeMesh> mixed = keyframesOf({flipped(sheet, 3)}), plain = keyframesOf({sheet});
  EXPECT_EQ(mend(named({}, true), mixed), "");
  EXPECT_EQ(mend(named({}, true), plain), "");
  EXPECT_EQ(mixed.front().mesh.triangles, plain.front().mesh.triangles);
}

// A weld that brings two corners of a face together names that face once.
TEST(MotionSplit, AFaceIsNotNamedAgainstItself) {
  TriangleMesh mesh = soup(octahedron(2));
  mesh.positions[1] = mesh.positions[0];
  std::vector<KeyframeMesh> keyframes = keyframesOf({mesh});
  const std::string error = errorOf([&] { mend(named(kWeld), keyframes); });
  EXPECT_NE(error.find("a.obj: face 1 uses one vertex for two corners: remove it, or set repair = "
                       "[\"drop-degenerate\"]"),
            std::string::npos)
      << error;
}

}  // namespace
}  // namespace echocine::motion_test
