// Meshes that several threads read and coarsen at once: the library below keeps state in the
// process, so its first use and its messages must never meet.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "motion/mesh/decimate.h"
#include "motion/mesh/mesh_io.h"
#include "support/meshes.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using support::Mesh;

constexpr std::size_t kThreads = 16;
constexpr int kTimes = 20;

template <typename Work>
void atOnce(const Work& work) {
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < kThreads; ++i)
    threads.emplace_back([&, i] {
      for (int times = 0; times < kTimes; ++times) work(i);
    });
  for (std::thread& thread : threads) thread.join();
}

std::string plyText(const Mesh& mesh) {
  std::string out = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.points.size(), mesh.triangles.size());
  for (const Vec3d p : mesh.points) out += fmt::format("{} {} {}\n", p.x, p.y, p.z);
  for (const Triangle& t : mesh.triangles) out += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return out;
}

std::string offText(const Mesh& mesh) {
  std::string out = fmt::format("OFF\n{} {} 0\n", mesh.points.size(), mesh.triangles.size());
  for (const Vec3d p : mesh.points) out += fmt::format("{} {} {}\n", p.x, p.y, p.z);
  for (const Triangle& t : mesh.triangles) out += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return out;
}

// Every face three times: the kernel refuses two of each, and says so each time.
TEST(MeshThreads, CoarseningIsTheSameAsOneByOne) {
  Mesh thrice = support::icosphere(1, 2);
  const std::vector<Triangle> once = thrice.triangles;
  for (int times = 0; times < 2; ++times)
    thrice.triangles.insert(thrice.triangles.end(), once.begin(), once.end());
  std::vector<Vec3f> points;
  for (const Vec3d p : thrice.points) points.push_back(toFloat(p));

  std::vector<DecimatedMesh> made(kThreads);
  atOnce([&](std::size_t i) { made[i] = decimated(thrice.triangles, points, 400); });
  const DecimatedMesh alone = decimated(thrice.triangles, points, 400);
  for (const DecimatedMesh& mesh : made) {
    EXPECT_EQ(mesh.triangles, alone.triangles);
    EXPECT_EQ(mesh.vertices, alone.vertices);
  }
}

// Each thread has a mesh of another size: what one reader counts for another would show.
TEST(MeshThreads, ReadingIsTheSameAsOneByOne) {
  const support::TempFolder folder;
  std::vector<std::filesystem::path> files;
  for (std::size_t i = 0; i < kThreads; ++i) {
    const Mesh mesh = support::sheet(2 + static_cast<int>(i), 1, 0);
    files.push_back(i % 2 == 0 ? folder.write(fmt::format("{}.ply", i), plyText(mesh))
                               : folder.write(fmt::format("{}.off", i), offText(mesh)));
  }
  const auto read = [&](std::size_t i) {
    Sha256 digest;
    return readMesh(files[i], digest);
  };
  std::vector<TriangleMesh> made(kThreads);
  atOnce([&](std::size_t i) { made[i] = read(i); });
  for (std::size_t i = 0; i < kThreads; ++i) {
    const TriangleMesh alone = read(i);
    EXPECT_EQ(made[i].triangles, alone.triangles);
    EXPECT_EQ(made[i].positions.size(), alone.positions.size());
    EXPECT_EQ(alone.triangles.size(),
              support::sheet(2 + static_cast<int>(i), 1, 0).triangles.size());
  }
}

}  // namespace
}  // namespace echocine
