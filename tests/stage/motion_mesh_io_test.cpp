// Reading mesh files: what each format yields, and what is refused and how.

#include <sys/resource.h>

#include <cstring>
#include <limits>
#include <random>

#include "motion/mesh/mesh_check.h"
#include "motion/mesh/mesh_io.h"
#include "motion/mesh/obj_reader.h"
#include "tests/stage/motion_fixtures.h"

namespace echocine::motion_test {
namespace {

TriangleMesh read(const std::filesystem::path& file) {
  Sha256 digest;
  return readMesh(file, digest);
}

std::string plyText(const TriangleMesh& mesh) {
  std::ostringstream text;
  text << "ply\nformat ascii 1.0\nelement vertex " << mesh.positions.size()
       << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
       << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3d& p : mesh.positions) text << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const Triangle& t : mesh.triangles)
    text << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  return text.str();
}

std::string offText(const TriangleMesh& mesh) {
  std::ostringstream text;
  text << "OFF\n" << mesh.positions.size() << ' ' << mesh.triangles.size() << " 0\n";
  for (const Vec3d& p : mesh.positions) text << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const Triangle& t : mesh.triangles)
    text << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  return text.str();
}

std::string stlText(const TriangleMesh& mesh) {
  std::ostringstream text;
  text << "solid ball\n";
  for (const Triangle& t : mesh.triangles) {
    text << "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t v : t) {
      const Vec3d p = mesh.positions[v];
      text << "vertex " << p.x << ' ' << p.y << ' ' << p.z << '\n';
    }
    text << "endloop\nendfacet\n";
  }
  text << "endsolid ball\n";
  return text.str();
}

std::string stlBinary(const TriangleMesh& mesh) {
  std::string bytes = "solid, as many writers of binary files begin";
  bytes.resize(80, ' ');
  const auto append = [&](const auto& value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  };
  append(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    append(Vec3f{});
    for (const std::uint32_t v : t) append(toFloat(mesh.positions[v]));
    append(std::uint16_t{0});
  }
  return bytes;
}

void expectBall(const TriangleMesh& mesh, const std::string& what) {
  EXPECT_EQ(mesh.positions.size(), 6u) << what;
  EXPECT_EQ(mesh.triangles.size(), 8u) << what;
  EXPECT_EQ(leakCount(mesh.triangles), 0u) << what;
  EXPECT_NEAR(signedVolume(mesh), 4.0 / 3.0 * 8.0, 1e-6) << what;
}

TEST(MotionMeshIo, EveryFormatYieldsTheSameMesh) {
  const TestFolder folder;
  const TriangleMesh ball = octahedron(2);
  expectBall(read(folder.write("ball.obj", objText(ball))), "obj");
  expectBall(read(folder.write("ball.ply", plyText(ball))), "ply");
  expectBall(read(folder.write("ball.off", offText(ball))), "off");
  expectBall(read(folder.write("text.stl", stlText(ball))), "stl text");
  expectBall(read(folder.write("binary.STL", stlBinary(ball))), "stl binary, upper-case extension");
}

TEST(MotionMeshIo, StlIsWeldedByExactlyEqualCoordinatesOnly) {
  const TestFolder folder;
  TriangleMesh two = octahedron(2);
  const auto apart = static_cast<double>(std::nextafter(2.0f, 3.0f));
  two.positions.push_back({apart, 0, 0});
  two.triangles.push_back({6, 2, 4});
  EXPECT_EQ(read(folder.write("two.stl", stlBinary(two))).positions.size(), 7u);
}

TEST(MotionMeshIo, ObjKeepsDoublePrecision) {
  EXPECT_EQ(parseObj("v 1000.123456789012 0 0\n").positions[0].x, 1000.123456789012);
}

TEST(MotionMeshIo, ObjStatementsThatDoNotConcernTheShapeAreSkipped) {
  const TriangleMesh mesh = parseObj(
      "# by hand\r\nmtllib none.mtl\no thing\nv +1 0 0 1.0\nv 0 1 0 0.5 0.5 0.5\nv\t0 0 1\nvt 0 0\n"
      "vn 0 0 1\nusemtl red\ns off\nf 1/1/1 2//1 \\\n 3/1 # end\nl 1 2\n");
  EXPECT_EQ(mesh.positions.size(), 3u);
  ASSERT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.triangles[0], (Triangle{0, 1, 2}));
}

// A comment may end in a backslash, as a path does, and a file in a line that would go on.
TEST(MotionMeshIo, ObjLinesAreContinuedByABackslashOutsideComments) {
  const TriangleMesh mesh = parseObj(
      "# exported from C:\\hearts\\\nv 0 0 0\nv 1 0 \\\n0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4 \\");
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.positions[1].x, 1);
  EXPECT_EQ(mesh.triangles.size(), 2u);
}

TEST(MotionMeshIo, ObjPolygonsBecomeFansAndNegativeNumbersCountBack) {
  const TriangleMesh mesh = parseObj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf -4 -3 -2 -1\n");
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[0], (Triangle{0, 1, 2}));
  EXPECT_EQ(mesh.triangles[1], (Triangle{0, 2, 3}));
}

TEST(MotionMeshIo, FacesAfterAPolygonKeepTheirNumber) {
  const TestFolder folder;
  const auto file =
      folder.write("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 2 3 4\nf 1 2 2\n");
  EXPECT_NE(
      errorOf([&] { checkFile(read(file), file); }).find("quad.obj: face 3 uses vertex 2 twice"),
      std::string::npos);
}

TEST(MotionMeshIo, PolygonsOfOtherFormatsBecomeFans) {
  const TestFolder folder;
  const std::string quad = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
  EXPECT_EQ(read(folder.write("quad.off", quad)).triangles.size(), 2u);
}

TEST(MotionMeshIo, BadObjLinesAreNamed) {
  const auto says = [](const std::string& text) { return errorOf([&] { parseObj(text); }); };
  EXPECT_EQ(says("v 1 2\n"), "1: vertex 1 has '' where a coordinate is needed");
  EXPECT_EQ(says("\nv 1 2 x\n"), "2: vertex 1 has 'x' where a coordinate is needed");
  EXPECT_EQ(says("v 1 2 3\nf 1 2\n"), "2: face 1 has 2 corners, at least 3 are needed");
  EXPECT_EQ(says("v 1 2 3\nf 0 1 2\n"), "2: face 1 uses vertex 0; numbers start at 1");
  EXPECT_EQ(says("v 1 2 3\nf -2 1 1\n"), "2: face 1 uses vertex -2; numbers start at 1");
  EXPECT_EQ(says("f 1 b 2\n"), "1: face 1 has 'b' where a vertex number is needed");
}

TEST(MotionMeshIo, UnusableFilesAreRefusedAtTheirPlace) {
  const TestFolder folder;
  const auto says = [&](const std::filesystem::path& file) {
    Sha256 digest;
    return errorOf([&] { readKeyframe({{file}, 0}, structureOf({}), digest); });
  };
  const std::string place = "scene.toml:7: structure.keyframes: ball: " + folder.path("").string();
  EXPECT_EQ(says(folder.write("a.vtk", "x")),
            place + "a.vtk: unknown kind of mesh file; obj, ply, off, stl and npz are accepted");
  EXPECT_EQ(says(folder.write("empty.obj", "")), place + "empty.obj: the file is empty");
  EXPECT_EQ(says(folder.write("bare.obj", "# nothing\n")),
            place + "bare.obj: a surface is needed, the file has 0 vertices and 0 faces");
  EXPECT_EQ(says(folder.write("bad.obj", "v 1\n")),
            place + "bad.obj:1: vertex 1 has '' where a coordinate is needed");
  EXPECT_NE(says(folder.path("missing.obj")).find(place + "missing.obj: cannot be opened"),
            std::string::npos);
  EXPECT_NE(says(folder.write("no.ply", "hello")).find(place + "no.ply: "), std::string::npos);
}

// The first file is damaged, which is found out only by reading.
TEST(MotionMeshIo, MissingFilesAreToldBeforeAnyIsRead) {
  const TestFolder folder;
  const Scene scene = sceneOf(structureOf(
      {folder.write("bad.obj", "v 1\n"), folder.path("gone.obj"), folder.path("gone_2.obj")}));
  const std::string error = errorOf([&] { readKeyframes(scene); });
  EXPECT_NE(error.find("gone.obj: cannot be opened: "), std::string::npos) << error;
  EXPECT_NE(error.find("; 1 more file is missing"), std::string::npos) << error;
}

TEST(MotionMeshIo, WrongCoordinatesAndIndicesAreNumberedFromOne) {
  const TestFolder folder;
  const auto says = [&](const std::string& text) {
    const std::string prefix = folder.path("a.obj").string() + ": ";
    const TriangleMesh mesh = read(folder.write("a.obj", text));
    const std::string error = errorOf([&] { checkFile(mesh, folder.path("a.obj")); });
    return error.starts_with(prefix) ? error.substr(prefix.size()) : error;
  };
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(says(corners + "f 1 2 3\n"), "no error");
  EXPECT_EQ(says(corners + "v nan 0 0\nf 1 2 3\n"),
            "vertex 4 has a coordinate that is not finite; correct it");
  EXPECT_EQ(says(corners + "f 1 2 3\nf 1 2 9\n"),
            "face 2 uses vertex 9, the file has 3 vertices; correct the face");
  EXPECT_EQ(says(corners + "f 1 2 2\n"),
            "face 1 uses vertex 2 twice; remove the face, or set repair = [\"drop-degenerate\"]");
}

TEST(MotionMeshIo, CutOffFilesAreRefused) {
  const TestFolder folder;
  const TriangleMesh ball = octahedron(2);
  const std::pair<std::string, std::string> files[] = {
      {"cut.ply", plyText(ball)}, {"cut.off", offText(ball)}, {"cut.stl", stlBinary(ball)}};
  for (const auto& [name, bytes] : files) {
    const auto file = folder.write(name, bytes.substr(0, bytes.size() - 12));
    EXPECT_NE(errorOf([&] { read(file); }).find(name + ": "), std::string::npos) << name;
  }
}

// Most memory that the program has held so far, bytes.
std::size_t peakBytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

TEST(MotionMeshIo, CountsThatLieTakeNoMemory) {
  const TestFolder folder;
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 19999999\nproperty float x\nproperty float "
      "y\nproperty "
      "float z\nelement face 39999999\nproperty list uchar int vertex_indices\nend_header\n";
  const auto binary = [](std::string text, std::size_t at) {
    text.replace(at, 5, "binary_little_endian");
    return text;
  };
  std::string list = ply;  // one face of four thousand million corners
  list.replace(list.find("19999999"), 8, "1");
  list.replace(list.find("39999999"), 8, "1");
  list.replace(list.find("uchar"), 5, "uint");
  list = binary(list, list.find("ascii")) + std::string(12, '\0') + "\xff\xff\xff\xff";
  std::string stl(80, ' ');
  stl += std::string("\xff\xff\xff\x7f", 4) + std::string(16, '\0');
  const std::pair<std::string, std::string> files[] = {
      {"text.ply", ply},
      {"binary.ply", binary(ply, ply.find("ascii"))},
      {"list.ply", list},
      {"counts.off", "OFF\n19999999 39999999 0\n0 0 0\n"},
      {"corners.off", "OFF\n1 1 0\n0 0 0\n2000000000 0 0 0\n"},
      {"binary.off", std::string("OFF BINARY\n\x01\x31\x2d\x00\x01\x31\x2d\x00\0\0\0\0", 23)},
      {"count.stl", stl}};
  const std::size_t before = peakBytes();
  for (const auto& [name, bytes] : files) {
    const auto file = folder.write(name, bytes);
    const std::string error = errorOf([&] { checkFile(read(file), file); });
    EXPECT_NE(error.find(name + ": "), std::string::npos) << name << ": " << error;
    EXPECT_LT(peakBytes() - before, std::size_t{64} << 20) << name;
  }
}

// No bytes may crash or hang the program or come out as a mesh that passes its checks with wrong
// parts.
TEST(MotionMeshIo, DamagedFilesNeverDoWorseThanASceneError) {
  const TestFolder folder;
  const TriangleMesh ball = octahedron(2);
  const std::pair<std::string, std::string> files[] = {{"f.obj", objText(ball)},
                                                       {"f.ply", plyText(ball)},
                                                       {"f.off", offText(ball)},
                                                       {"text.stl", stlText(ball)},
                                                       {"binary.stl", stlBinary(ball)}};
  std::mt19937 random(1);
  const auto below = [&](std::size_t n) { return random() % n; };
  for (const auto& [name, bytes] : files) {
    for (int round = 0; round < 200; ++round) {
      std::string damaged = bytes;
      for (std::size_t i = 0, n = 1 + below(4); i < n; ++i)
        damaged[below(damaged.size())] = static_cast<char>(below(2) ? '0' + below(10) : below(256));
      if (below(4) == 0) damaged.resize(below(damaged.size()));
      const auto file = folder.write(name, damaged);
      errorOf([&] { checkFile(read(file), file); });
    }
  }
}

}  // namespace
}  // namespace echocine::motion_test
