// Every way a sequence of meshes can be unfit, and the words that say so.

#include "motion/mesh/mesh_check.h"

#include "motion/mesh/mesh_io.h"
#include "tests/stage/motion_fixtures.h"

namespace echocine::motion_test {
namespace {

KeyframeMesh keyframeOf(TriangleMesh mesh, const char* file = "a.obj") {
  return {std::move(mesh), {{file, 0, 0}}};
}

std::string says(const std::vector<KeyframeMesh>& keyframes, bool membrane = false,
                 double mesh_unit_m = 0.01) {
  Structure structure;
  structure.name = "ball";
  structure.place = {"scene.toml", 7, "structure"};
  structure.membrane = membrane;
  const std::string prefix = "scene.toml:7: structure: ball: ";
  const std::string error = errorOf([&] { checkKeyframes(structure, keyframes, mesh_unit_m); });
  return error.starts_with(prefix) ? error.substr(prefix.size()) : error;
}

TEST(MotionMeshCheck, ClosedBallPasses) {
  EXPECT_EQ(says({keyframeOf(octahedron(2)), keyframeOf(octahedron(1.5))}), "no error");
}

TEST(MotionMeshCheck, AnotherVertexOrFaceCountNamesBothFiles) {
  TriangleMesh more_vertices = octahedron(2), fewer_faces = octahedron(2);
  more_vertices.positions.push_back({});
  fewer_faces.triangles.pop_back();
  EXPECT_EQ(says({keyframeOf(octahedron(2)), keyframeOf(more_vertices, "b.obj")}),
            "b.obj has 7 vertices, a.obj has 6; every keyframe must have the same");
  EXPECT_EQ(says({keyframeOf(octahedron(2)), keyframeOf(fewer_faces, "b.obj")}),
            "b.obj has 7 faces, a.obj has 8; every keyframe must have the same");
}

TEST(MotionMeshCheck, FirstDifferingFaceIsNamedWithBothFiles) {
  TriangleMesh turned = octahedron(2);
  turned.triangles[4] = {0, 5, 2};
  EXPECT_EQ(says({keyframeOf(octahedron(2)), keyframeOf(turned, "b.obj")}),
            "b.obj: face 5 differs from the same face of a.obj; every keyframe must have the same "
            "faces");
}

TEST(MotionMeshCheck, OpenEdgesAreCountedUnlessItIsAMembrane) {
  TriangleMesh open = octahedron(2);
  open.triangles.pop_back();
  EXPECT_EQ(
      says({keyframeOf(open)}),
      "a.obj: face 4 has an open edge (2, 0, 0) - (0, -2, 0), one of 3; accepted: a closed "
      "mesh, lids which close it, repair = [\"fill-holes\"], or membrane = true for an open sheet");
  EXPECT_EQ(says({keyframeOf(open)}, true), "no error");
}

TEST(MotionMeshCheck, EdgesOfThreeFacesAreRefusedInMembranesToo) {
  TriangleMesh fin = octahedron(2);
  fin.positions.push_back({3, 3, 0});
  fin.triangles.push_back({0, 2, 6});
  const std::string error =
      "a.obj: face 1: edge (2, 0, 0) - (0, 2, 0) belongs to 3 faces, the last is a.obj: face 9; at "
      "most two are accepted: separate the surfaces that meet there, or set repair = [\"split\"]";
  EXPECT_EQ(says({keyframeOf(fin)}), error);
  EXPECT_EQ(says({keyframeOf(fin)}, true), error);
}

TEST(MotionMeshCheck, FacesOrientedAgainstEachOtherAreNamed) {
  TriangleMesh turned = octahedron(2);
  std::swap(turned.triangles[0][1], turned.triangles[0][2]);
  const std::string error =
      "a.obj: face 1 and a.obj: face 5 run their common edge (2, 0, 0) - (0, 2, 0) in the same "
      "direction; faces must be oriented consistently: reverse one of them, or set repair = "
      "[\"orient\"]";
  EXPECT_EQ(says({keyframeOf(turned)}), error);
  EXPECT_EQ(says({keyframeOf(turned)}, true), "no error");  // a membrane has no outside
}

TEST(MotionMeshCheck, InsideOutIsRefusedInTheFirstAndInLaterKeyframes) {
  TriangleMesh inward = octahedron(1);
  for (Triangle& t : inward.triangles) std::swap(t[1], t[2]);
  EXPECT_EQ(
      says({keyframeOf(inward)}),
      "a.obj encloses a volume of -1.333 cubic mesh units: its faces look inward; reverse the "
      "vertex order of every face, or set repair = [\"orient\"]");
  TriangleMesh mirrored = octahedron(1);
  for (Vec3d& p : mirrored.positions) p.x = -p.x;
  EXPECT_EQ(
      says({keyframeOf(octahedron(1)), keyframeOf(mirrored, "b.obj")}),
      "b.obj encloses a volume of -1.333 cubic mesh units: this keyframe is turned inside out "
      "or mirrored; correct its vertices");
}

TEST(MotionMeshCheck, ImplausibleSizeNamesTheUnit) {
  EXPECT_EQ(
      says({keyframeOf(octahedron(50))}, false, 1.0),
      "a.obj measures 100 mesh units, 100 m by motion.mesh_unit; 1 mm to 2 m is "
      "accepted: correct motion.mesh_unit or motion.mesh_scale (a chamber of 80 mm takes 0.8 mm "
      "per mesh unit)");
  EXPECT_NE(says({keyframeOf(octahedron(0.04))}).find("correct motion.mesh_unit"),
            std::string::npos);
  EXPECT_EQ(says({keyframeOf(octahedron(50))}, false, 0.01), "no error");
}

TEST(MotionMeshCheck, VolumeDoesNotDependOnWhereTheMeshIs) {
  EXPECT_NEAR(signedVolume(octahedron(1, {1e6, -1e6, 1e6})), 4.0 / 3.0, 1e-8);
}

// An octahedron without its upper half, which a separate file closes.
struct OpenBallAndLid {
  TestFolder folder;
  std::filesystem::path bowl, lid;
  OpenBallAndLid() {
    TriangleMesh open = octahedron(2);
    open.triangles.erase(open.triangles.begin(), open.triangles.begin() + 4);
    bowl = folder.write("bowl.obj", objText(open));
    lid = folder.write("lid.obj",
                       "v 0 -2 -0\nv 2 -0 0\nv 0 2 0\nv -2 0 0\nv 0 0 1\n"
                       "f 2 3 5\nf 3 4 5\nf 4 1 5\nf 1 2 5\n");
  }
  KeyframeMesh joined() const {
    Sha256 digest;
    return readKeyframe({{bowl, lid}, 0}, structureOf({}), digest);
  }
};

TEST(MotionMeshCheck, LidsAreWeldedAndClose) {
  const OpenBallAndLid files;
  const KeyframeMesh joined = files.joined();
  EXPECT_EQ(joined.mesh.positions.size(), 7u);  // the bowl's 6 (one unused) and the lid's middle
  EXPECT_EQ(leakCount(joined.mesh.triangles), 0u);
  EXPECT_NEAR(signedVolume(joined.mesh), 8.0 * 2.0 / 3.0 + 8.0 / 3.0, 1e-12);
  EXPECT_EQ(says({joined}), "no error");
}

TEST(MotionMeshCheck, ALidThatMissesTheRimInOneKeyframeIsNamed) {
  const OpenBallAndLid files;
  TestFolder folder;
  const auto off = folder.write("off.obj",
                                "v 0 -2 -0\nv 2 -0 0\nv 0 2.001 0\nv -2 0 0\nv 0 0 1\n"
                                "f 2 3 5\nf 3 4 5\nf 4 1 5\nf 1 2 5\n");
  Sha256 digest;
  const KeyframeMesh missed = readKeyframe({{files.bowl, off}, 0.5}, structureOf({}), digest);
  EXPECT_EQ(says({files.joined(), missed}),
            "lid " + off.string() + " adds 2 vertices to its keyframe, " + files.lid.string() +
                " adds 1; every keyframe must have the same: a lid's vertex joins the mesh where "
                "both have exactly the same coordinates");
}

TEST(MotionMeshCheck, FacesOfLidsAreNamedInTheirOwnFile) {
  const OpenBallAndLid files;
  KeyframeMesh joined = files.joined();
  joined.mesh.triangles.pop_back();
  EXPECT_NE(says({joined}).find("bowl.obj: face 4 has an open edge"), std::string::npos);
  joined = files.joined();
  std::swap(joined.mesh.triangles[5][0], joined.mesh.triangles[5][1]);
  EXPECT_NE(says({joined}).find("lid.obj: face 2"), std::string::npos);
}

TEST(MotionMeshCheck, LidFaceThatCollapsesIsNamed) {
  const TestFolder folder;
  const auto bowl = folder.write("bowl.obj", objText(octahedron(2)));
  const auto lid = folder.write("lid.obj", "v 2 0 0\nv 2 0 0\nv 0 0 9\nf 1 2 3\n");
  Sha256 digest;
  EXPECT_EQ(errorOf([&] {
              readKeyframe({{bowl, lid}, 0}, structureOf({}), digest);
            }),
            "scene.toml:7: structure.keyframes: ball: " + lid.string() +
                ": face 1 has two corners at the same place; a lid cannot be joined with "
                "such a face: remove it, or set repair = [\"drop-degenerate\"]");
}

}  // namespace
}  // namespace echocine::motion_test
