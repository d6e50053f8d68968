// Keyframes in NumPy files: every type and order that NumPy writes, and one line for each fault.

#include "motion/mesh/npz_meshes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <random>

#include "core/parallel.h"
#include "motion/mesh/mesh_io.h"
#include "motion/surfaces/keyframe_set.h"
#include "motion_fixtures.h"
#include "output/npy.h"
#include "output/zip.h"
#include "scene/npz_keyframe.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace motion_test;
using motion_test::errorOf, motion_test::sceneOf;  // tests beside this one have others

using Bytes = std::vector<std::byte>;

// An array as numpy.save writes it. `order`: '<' or '>'.
template <typename T>
Bytes npy(const std::string& kind, char order, bool fortran, const std::vector<std::size_t>& shape,
          const std::vector<double>& values) {
  std::string header = fmt::format("{{'descr': '{}{}{}', 'fortran_order': {}, 'shape': ({},), }}",
                                   sizeof(T) == 1 ? '|' : order, kind, sizeof(T),
                                   fortran ? "True" : "False", fmt::join(shape, ", "));
  header.append(117 - header.size() % 64, ' ');
  header.back() = '\n';
  Bytes file;
  append(file, std::string_view("\x93NUMPY\x01\x00", 8));
  append(file, static_cast<std::uint16_t>(header.size()));
  append(file, std::string_view(header));
  for (const double value : values) {
    auto bytes = std::bit_cast<std::array<std::byte, sizeof(T)>>(static_cast<T>(value));
    if (order == '>') std::reverse(bytes.begin(), bytes.end());
    file.insert(file.end(), bytes.begin(), bytes.end());
  }
  return file;
}

// C order to Fortran order, by its definition: index (i, j, k) is at i + I (j + J k).
std::vector<double> turned(const std::vector<double>& values, std::size_t ni, std::size_t nj,
                           std::size_t nk) {
  std::vector<double> result(values.size());
  for (std::size_t i = 0; i < ni; ++i)
    for (std::size_t j = 0; j < nj; ++j)
      for (std::size_t k = 0; k < nk; ++k)
        result[i + ni * (j + nj * k)] = values[(i * nj + j) * nk + k];
  return result;
}

struct Ball {
  std::vector<double> points, faces;
  std::size_t keyframes = 3, vertices = 6;

  Ball() {
    for (std::size_t k = 0; k < keyframes; ++k)
      for (const Vec3d& p : octahedron(2 + 0.5 * static_cast<double>(k)).positions)
        points.insert(points.end(), {p.x, p.y, p.z});
    for (const Triangle& t : octahedron(1).triangles)
      for (const std::uint32_t v : t) faces.push_back(v);
  }
  Bytes pointsFile() const { return npy<double>("f", '<', false, {keyframes, 6, 3}, points); }
  Bytes facesFile() const { return npy<std::int32_t>("i", '<', false, {8, 3}, faces); }
};

class NpzKeyframes : public testing::Test {
 protected:
  std::filesystem::path write(const std::vector<NamedArray>& arrays) const {
    const Bytes file = npzBytes(arrays);
    return folder.write("ball.npz", {reinterpret_cast<const char*>(file.data()), file.size()});
  }
  void expectBall(const NpzMeshes& meshes, const std::string& what) const {
    ASSERT_EQ(meshes.keyframes, ball.keyframes) << what;
    for (std::size_t k = 0; k < ball.keyframes; ++k) {
      const TriangleMesh expected = octahedron(2 + 0.5 * static_cast<double>(k));
      EXPECT_EQ(meshes.mesh(k).positions, expected.positions) << what;
      EXPECT_EQ(meshes.mesh(k).triangles, expected.triangles) << what;
    }
  }
  // One line that starts with the file's name.
  void expectRefused(const std::vector<NamedArray>& arrays, const std::string& words) const {
    const std::filesystem::path file = write(arrays);
    EXPECT_EQ(errorOf([&] { readNpzMeshes(file); }), file.string() + ": " + words);
  }
  TestFolder folder;
  Ball ball;
};

TEST_F(NpzKeyframes, EveryTypeAndOrderGivesTheSameMeshes) {
  for (const char order : {'<', '>'})
    for (const bool fortran : {false, true}) {
      const std::vector<double> points = fortran ? turned(ball.points, 3, 6, 3) : ball.points;
      const std::vector<double> faces = fortran ? turned(ball.faces, 8, 3, 1) : ball.faces;
      const std::vector<std::size_t> p{3, 6, 3}, f{8, 3};
      const Bytes point_files[] = {npy<double>("f", order, fortran, p, points),
                                   npy<float>("f", order, fortran, p, points)};
      const Bytes face_files[] = {npy<std::int8_t>("i", order, fortran, f, faces),
                                  npy<std::int16_t>("i", order, fortran, f, faces),
                                  npy<std::int32_t>("i", order, fortran, f, faces),
                                  npy<std::int64_t>("i", order, fortran, f, faces),
                                  npy<std::uint8_t>("u", order, fortran, f, faces),
                                  npy<std::uint16_t>("u", order, fortran, f, faces),
                                  npy<std::uint32_t>("u", order, fortran, f, faces),
                                  npy<std::uint64_t>("u", order, fortran, f, faces)};
      for (const Bytes& point_file : point_files)
        for (const Bytes& face_file : face_files)
          expectBall(readNpzMeshes(write({{"points", point_file}, {"faces", face_file}})),
                     fmt::format("{} fortran {}", order, fortran));
    }
}

TEST_F(NpzKeyframes, OneLineNamesTheFault) {
  const Bytes p = ball.pointsFile(), f = ball.facesFile();
  expectRefused({{"points", p}}, "has no array \"faces\"; its arrays: points");
  expectRefused({{"point", p}, {"faces", f}},
                "has the array \"point\", accepted: points, faces, corners, corner_sharpness, "
                "creases, crease_sharpness");
  expectRefused({{"points", npy<double>("f", '<', false, {18, 3}, ball.points)}, {"faces", f}},
                "points is (18, 3), accepted: (K, V, 3), K keyframes of V vertices");
  expectRefused({{"points", npy<double>("f", '<', false, {3, 9, 2}, ball.points)}, {"faces", f}},
                "points is (3, 9, 2), accepted: (K, V, 3), K keyframes of V vertices");
  expectRefused({{"points", p}, {"faces", npy<std::int32_t>("i", '<', false, {6, 4}, ball.faces)}},
                "faces is (6, 4), accepted: (F, 3), triangles");
  expectRefused({{"points", p}, {"faces", npy<float>("f", '<', false, {8, 3}, ball.faces)}},
                "faces has floats, accepted: integers");
  Ball bad = ball;
  bad.points[1 * 18 + 4 * 3 + 2] = std::numeric_limits<double>::quiet_NaN();
  expectRefused({{"points", bad.pointsFile()}, {"faces", f}},
                "points[1, 4, 2] is nan, accepted: finite numbers");
  bad = ball;
  bad.faces[5] = 6;
  expectRefused({{"points", p}, {"faces", bad.facesFile()}},
                "faces[1, 2] has vertex 6, accepted: 0 to 5, a row of points");
  bad.faces[5] = -1;
  expectRefused({{"points", p}, {"faces", bad.facesFile()}},
                "faces[1, 2] has vertex -1, accepted: 0 to 5, a row of points");
  Bytes object = p;  // '<f8' -> '|O8'
  const std::string_view text(reinterpret_cast<const char*>(object.data()), object.size());
  std::memcpy(object.data() + text.find("<f8"), "|O8", 3);
  expectRefused({{"points", object}, {"faces", f}},
                "points has the type \"|O8\", accepted: integers, float32 or float64");
  expectRefused({{"points", npy<double>("f", '<', false, {3, 7, 3}, ball.points)}, {"faces", f}},
                "points has the shape (3, 7, 3), but 432 bytes of data");
  const std::size_t huge = std::size_t{1} << 62;
  expectRefused({{"points", npy<double>("f", '<', false, {huge, 6, 3}, ball.points)}, {"faces", f}},
                fmt::format("points has the shape ({}, 6, 3), but 432 bytes of data", huge));
  expectRefused({{"points", Bytes(40)}, {"faces", f}}, "points is no sound .npy array");
}

TEST_F(NpzKeyframes, CreasesAndCornersAreThoseOfAnObjFile) {
  const std::vector<NamedArray> arrays{
      {"points", ball.pointsFile()},
      {"faces", ball.facesFile()},
      {"corners", npy<std::int64_t>("i", '<', false, {3}, {4, 1, 5})},
      {"corner_sharpness", npy<float>("f", '<', false, {3}, {10, 2.5, 0})},
      {"creases", npy<std::int64_t>("i", '<', false, {2, 2}, {4, 0, 0, 2})},
      {"crease_sharpness", npy<double>("f", '<', false, {2}, {3, 99})}};
  const Structure structure = structureOf({});
  Sha256 digest;
  const std::filesystem::path obj =
      folder.write("ball.obj", objText(octahedron(2)) +
                                   "t corner 1/1/0 4 10\nt corner 1/1/0 1 2.5\n"
                                   "t crease 2/1/0 4 0 3\nt crease 2/1/0 0 2 99\n");
  EXPECT_EQ(readNpzMeshes(write(arrays)).tags,
            readKeyframe({{obj}, 0}, structure, digest).mesh.tags);
  std::vector<NamedArray> bad = arrays;
  bad.pop_back();
  expectRefused(bad, "has creases without crease_sharpness");
  bad = arrays;
  bad.erase(bad.begin() + 4);
  expectRefused(bad, "has crease_sharpness without creases");
  bad = arrays;
  bad[4].npy = npy<std::int64_t>("i", '<', false, {2, 2}, {4, 0, 4, 5});
  expectRefused(bad, "creases has the row (4, 5), accepted: edges of a face");
  bad = arrays;
  bad[3].npy = npy<float>("f", '<', false, {2}, {10, 2.5});
  expectRefused(bad, "corner_sharpness is (2,), accepted: (3,), one for each row of corners");
}

// A flipped bit is found by a checksum, or does not matter; a cut file is refused.
TEST_F(NpzKeyframes, DamageIsRefusedInOneLine) {
  const std::string sound =
      support::bytesOf(write({{"points", ball.pointsFile()}, {"faces", ball.facesFile()}}));
  const std::filesystem::path file = folder.path("ball.npz");
  for (std::size_t bit = 0; bit < 8 * sound.size(); bit += 5) {
    std::string damaged = sound;
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << (bit % 8)));
    folder.write("ball.npz", damaged);
    try {
      expectBall(readNpzMeshes(file), fmt::format("bit {}", bit));
    } catch (const SceneError& error) {
      EXPECT_EQ(std::string(error.what()).find(file.string() + ": "), 0u) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  for (std::size_t size = 0; size < sound.size(); size += 7) {
    folder.write("ball.npz", sound.substr(0, size));
    EXPECT_NE(errorOf([&] { readNpzMeshes(file); }), "no error") << size;
  }
}

// Sizes that the archive cannot hold are refused before memory is taken for them.
TEST_F(NpzKeyframes, ADeclaredSizeBeyondTheArchiveIsRefused) {
  std::string bytes =
      support::bytesOf(write({{"points", ball.pointsFile()}, {"faces", ball.facesFile()}}));
  const std::size_t entry = bytes.find("PK\x01\x02");
  const auto declare = [&](std::uint16_t method, std::uint32_t packed, std::uint32_t whole) {
    std::memcpy(bytes.data() + entry + 10, &method, sizeof method);
    std::memcpy(bytes.data() + entry + 20, &packed, sizeof packed);
    std::memcpy(bytes.data() + entry + 24, &whole, sizeof whole);
    const std::filesystem::path file = folder.write("ball.npz", bytes);
    return errorOf([&] { readNpzMeshes(file); });
  };
  const std::string refused = folder.path("ball.npz").string() +
                              ": is no sound zip archive: a size in its directory is impossible";
  EXPECT_EQ(declare(0, 0xfffffff0u, 0xfffffff0u), refused);
  EXPECT_EQ(declare(8, 500, 0xfffffff0u), refused);
  EXPECT_EQ(declare(0, 500, 0xfffffff0u), refused);
  EXPECT_NE(declare(8, 500, 500000).find(": points "), std::string::npos);
}

// One file for all keyframes is the same as a file for each.
TEST_F(NpzKeyframes, AreTheKeyframesOfAScene) {
  const std::filesystem::path npz =
      write({{"points", ball.pointsFile()}, {"faces", ball.facesFile()}});
  const std::vector<std::filesystem::path> names = npzKeyframeNames(npz);
  ASSERT_EQ(names.size(), 3u);
  EXPECT_EQ(names[2], npz.string() + "[2]");
  std::vector<std::filesystem::path> files;
  for (int k = 0; k < 3; ++k)
    files.push_back(folder.write(fmt::format("{}.obj", k), objText(octahedron(2 + 0.5 * k))));
  const KeyframeSet from_obj = readKeyframes(sceneOf(structureOf(files)));
  for (const int threads : {1, 2, 4}) {
    KeyframeSet set;
    withThreads(threads, [&] { set = readKeyframes(sceneOf(structureOf(names))); });
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(set.structures[0][k].mesh.positions, from_obj.structures[0][k].mesh.positions);
      EXPECT_EQ(set.structures[0][k].mesh.triangles, from_obj.structures[0][k].mesh.triangles);
    }
    EXPECT_NE(set.sha256, from_obj.sha256);
  }
  EXPECT_EQ(errorOf([&] { readKeyframes(sceneOf(structureOf({npz}))); }),
            "scene.toml:7: structure.keyframes: ball: " + npz.string() +
                ": the file has 3 keyframes, accepted: ball.npz[0] to ball.npz[2]");
  const std::string fourth = npz.string() + "[3]";
  EXPECT_EQ(errorOf([&] { readKeyframes(sceneOf(structureOf({fourth}))); }),
            "scene.toml:7: structure.keyframes: ball: " + fourth +
                ": the file has 3 keyframes, accepted: ball.npz[0] to ball.npz[2]");
  EXPECT_EQ(errorOf([&] { readKeyframes(sceneOf(structureOf({folder.path("no.npz[1]")}))); }),
            "scene.toml:7: structure.keyframes: ball: " + folder.path("no.npz[1]").string() +
                ": cannot be opened: No such file or directory");
}

TEST(NpzNames, AreAFileAndANumber) {
  EXPECT_FALSE(npzKeyframeOf("a.obj"));
  EXPECT_FALSE(npzKeyframeOf("a[3].obj"));
  EXPECT_FALSE(npzKeyframeOf("a.npz[]"));
  EXPECT_FALSE(npzKeyframeOf("a.npz[-1]"));
  EXPECT_FALSE(npzKeyframeOf("a.npz[1"));
  EXPECT_FALSE(npzKeyframeOf("a.npz[1x]"));
  EXPECT_FALSE(npzKeyframeOf("a.npz[99999999999999999999]"));
  EXPECT_EQ(npzKeyframeOf("b/a.npz")->keyframe, std::nullopt);
  EXPECT_EQ(npzKeyframeOf("b/a.npz[12]")->file, "b/a.npz");
  EXPECT_EQ(npzKeyframeOf("b/a.npz[12]")->keyframe, 12u);
}

}  // namespace
}  // namespace echocine
