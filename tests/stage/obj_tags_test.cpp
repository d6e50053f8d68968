// The tag lines of an OBJ file: what they become, and every way they can be wrong.

#include "motion/mesh/mesh_check.h"
#include "motion/mesh/mesh_io.h"
#include "motion/mesh/obj_reader.h"
#include "tests/stage/crease_fixtures.h"

namespace echocine::motion_test {
namespace {

const std::string kBall = objText(octahedron(1));  // 6 vertices, 8 faces, 14 lines

TEST(ObjTags, AreReadInAnyOrderAndBeforeTheFacesTheyName) {
  const TriangleMesh a = parseObj(kBall +
                                  "t crease 2/1/0 0 2 1.5\nt corner 1/1/0 4 +3e0\n"
                                  "t crease 2/1/0 4 2 99 # infinitely sharp\n");
  const TriangleMesh b = parseObj(
      "t crease 2/1/0 2 4 inf\nt corner 1/1/0 4 3\nt crease 2/1/0 2 0 1.5\n"
      "t crease 2/1/0 0 2 1.5\nt corner 1/1/0 5 0\n" +
      kBall);
  ASSERT_EQ(a.tags.edges.size(), 2u);
  EXPECT_EQ(a.tags.edges[0], (SharpEdge{0, 2, 1.5f}));
  EXPECT_EQ(a.tags.edges[1], (SharpEdge{2, 4, kInfiniteSharpness}));
  ASSERT_EQ(a.tags.vertices.size(), 1u);
  EXPECT_EQ(a.tags.vertices[0], (SharpVertex{4, 3}));
  EXPECT_EQ(a.tags, b.tags);
  EXPECT_EQ(refined(a, 2).positions, refined(b, 2).positions);
  EXPECT_TRUE(parseObj(kBall + "t crease 2/1/0 0 2 0\n").tags.empty());
}

TEST(ObjTags, BadOnesAreNamedWithTheirLine) {
  const auto says = [](const std::string& tag) {
    return errorOf([&] { parseObj(kBall + tag + "\n"); });
  };
  const std::string accepted =
      "accepted: t crease 2/1/0 v0 v1 sharpness, t corner 1/1/0 v sharpness";
  EXPECT_EQ(says("t crease 2/1/0 0 2 3"), "no error");
  EXPECT_EQ(says("t hole 1/0/0 3"), "15: unknown tag 'hole'; " + accepted);
  EXPECT_EQ(says("t"), "15: unknown tag ''; " + accepted);
  EXPECT_EQ(says("t crease 1/1/0 0 2 3"),
            "15: the tag has '1/1/0' where '2/1/0' is needed; " + accepted);
  EXPECT_EQ(says("t corner 2/1/0 0 2"),
            "15: the tag has '2/1/0' where '1/1/0' is needed; " + accepted);
  EXPECT_EQ(says("t crease 2/1/0 0 x 3"),
            "15: the tag has 'x' where a vertex number, from 0, is needed; " + accepted);
  EXPECT_EQ(says("t corner 1/1/0 -1 3"),
            "15: the tag has '-1' where a vertex number, from 0, is needed; " + accepted);
  EXPECT_EQ(says("t crease 2/1/0 0 2"),
            "15: the tag has '' where a sharpness is needed; " + accepted);
  EXPECT_EQ(says("t crease 2/1/0 0 2 3 4"),
            "15: the tag goes on with '4' after its sharpness; " + accepted);
  const std::string range = " is not accepted: 0 (smooth) and up, 10 and more are infinitely sharp";
  EXPECT_EQ(says("t crease 2/1/0 0 2 -1"), "15: sharpness -1" + range);
  EXPECT_EQ(says("t corner 1/1/0 0 nan"), "15: sharpness nan" + range);
  EXPECT_EQ(says("t crease 2/1/0 0 1 3"),
            "15: crease 0 - 1 is not an edge of a face; vertices count from 0 in tags");
  EXPECT_EQ(says("t crease 2/1/0 2 2 3"),
            "15: crease 2 - 2 is not an edge of a face; vertices count from 0 in tags");
  EXPECT_EQ(says("t corner 1/1/0 6 3"),
            "15: the tag names vertex 6; the file's 6 vertices count from 0 in tags");
  EXPECT_EQ(says("t crease 2/1/0 0 2 3\nt crease 2/1/0 2 0 4"),
            "16: crease 0 - 2 has sharpness 4 here and 3 in line 15; one is accepted");
}

// Also when the scene does not subdivide: what cannot be right is said at once.
TEST(ObjTags, AreCheckedWithoutSubdivisionAndHaveNoEffectThen) {
  const TestFolder folder;
  Scene scene = sceneOf(structureOf({folder.write("a.obj", kBall + "t corner 1/1/0 9 1\n")}));
  EXPECT_EQ(errorOf([&] { MeshMotion{scene}; }),
            "scene.toml:7: structure.keyframes: ball: " + folder.path("a.obj").string() +
                ":15: the tag names vertex 9; the file's 6 vertices count from 0 in tags");
  scene.structures[0].keyframes[0].files = {folder.write("b.obj", kBall + "t corner 1/1/0 4 9\n")};
  const MeshMotion tagged(scene);
  SurfaceFrame frame;
  tagged.frameAt(0, frame);
  for (std::size_t v = 0; v < 6; ++v)
    EXPECT_EQ(frame.positions_m[0][v], toFloat(0.01 * octahedron(1).positions[v]));
}

// The drum's wall and its two caps in files of their own; creases stand in a cap's file.
TEST(ObjTags, OfLidsTakeTheNumbersOfTheJoinedMesh) {
  const TestFolder folder;
  const TriangleMesh drum = cylinder(6, 3, 0);
  TriangleMesh wall = drum, lid, floor;
  std::erase_if(wall.triangles, [](const Triangle& t) { return t[0] >= 18; });
  wall.positions.resize(18);
  lid.positions.assign(drum.positions.end() - 1, drum.positions.end());
  lid.positions.insert(lid.positions.end(), drum.positions.begin() + 12,
                       drum.positions.begin() + 18);
  floor.positions.assign(drum.positions.begin(), drum.positions.begin() + 6);
  floor.positions.push_back(drum.positions[18]);
  std::string creases;
  for (std::uint32_t s = 0; s < 6; ++s) {
    lid.triangles.push_back({0, 1 + s, 1 + (s + 1) % 6});
    floor.triangles.push_back({6, (s + 1) % 6, s});
    creases +=
        "t crease 2/1/0 " + std::to_string(1 + s) + " " + std::to_string(1 + (s + 1) % 6) + " 4\n";
  }
  Keyframe keyframe{
      {folder.write("wall.obj", objText(wall)), folder.write("floor.obj", objText(floor)),
       folder.write("lid.obj", objText(lid) + creases)},
      0};
  Sha256 digest;
  const KeyframeMesh joined = readKeyframe(keyframe, structureOf({}), digest);
  ASSERT_EQ(joined.mesh.tags.edges.size(), 6u);
  for (const SharpEdge& e : joined.mesh.tags.edges) {
    EXPECT_GE(e.v0, 12u);  // the wall's last ring
    EXPECT_LT(e.v1, 18u);
    EXPECT_EQ(e.sharpness, 4);
  }
  // The same edge tagged by the wall with another sharpness.
  keyframe.files[0] = folder.write("wall.obj", objText(wall) + "t crease 2/1/0 12 13 5\n");
  EXPECT_EQ(errorOf([&] { readKeyframe(keyframe, structureOf({}), digest); }),
            "scene.toml:7: structure.keyframes: ball: " + folder.path("lid.obj").string() +
                ": a crease or corner has sharpness 5 and 4 where the lid is joined; one sharpness "
                "is accepted");
  keyframe.files[0] = folder.write("wall.obj", objText(wall) + "t crease 2/1/0 12 13 4\n");
  EXPECT_EQ(readKeyframe(keyframe, structureOf({}), digest).mesh.tags, joined.mesh.tags);
}

TEST(ObjTags, StandInEveryKeyframeOrInTheFirstOnly) {
  const TestFolder folder;
  const std::string crease = "t crease 2/1/0 0 2 3\n", other = "t crease 2/1/0 0 2 4\n";
  const auto says = [&](const std::vector<std::string>& tags) {
    std::vector<std::filesystem::path> files;
    for (std::size_t k = 0; k < tags.size(); ++k)
      files.push_back(
          folder.write(std::string(1, static_cast<char>('a' + k)) + ".obj", kBall + tags[k]));
    return errorOf([&] { MeshMotion{sceneOf(structureOf(files))}; });
  };
  const auto refusal = [&](const char* file, const char* given) {
    return "scene.toml:7: structure.keyframes: ball: " + folder.path(file).string() +
           " has other creases or corners than " + folder.path(given).string() +
           "; accepted: the same `t` lines in every keyframe, or in the first one only";
  };
  EXPECT_EQ(says({crease, crease, crease}), "no error");
  EXPECT_EQ(says({crease, "", ""}), "no error");
  EXPECT_EQ(says({crease, other, crease}), refusal("b.obj", "a.obj"));
  EXPECT_EQ(says({"", crease, crease}), refusal("b.obj", "a.obj"));
  EXPECT_EQ(says({crease, crease, ""}), refusal("c.obj", "a.obj"));
  EXPECT_EQ(says({crease, "", crease}), refusal("c.obj", "b.obj"));
}

}  // namespace
}  // namespace echocine::motion_test
