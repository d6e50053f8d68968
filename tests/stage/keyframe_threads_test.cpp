// Keyframes are read in parallel: the same meshes, digest and first error for any number of
// threads.

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "core/parallel.h"
#include "motion/surfaces/keyframe_set.h"
#include "motion_fixtures.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace motion_test;

constexpr int kStructures = 4, kInstants = 9;

class ReadingKeyframes : public testing::Test {
 protected:
  ReadingKeyframes() {
    Structure first = ball(0);
    scene = sceneOf(first);
    for (int s = 1; s < kStructures; ++s) scene.structures.push_back(ball(s));
  }
  static std::string name(int structure, int keyframe) {
    return fmt::format("s{}_k{}.obj", structure, keyframe);
  }
  Structure ball(int s) const {
    std::vector<std::filesystem::path> files;
    for (int k = 0; k < kInstants; ++k)
      files.push_back(folder.write(name(s, k), objText(sphere(2 + 0.01 * k + 0.1 * s, 2))));
    return structureOf(files);
  }
  KeyframeSet read(int threads) const {
    KeyframeSet set;
    withThreads(threads, [&] { set = readKeyframes(scene); });
    return set;
  }
  void expectError(const std::string& words) const {
    const std::string one = errorOf([&] { read(1); });
    EXPECT_NE(one.find(words), std::string::npos) << one;
    for (int round = 0; round < 10; ++round)
      for (const int threads : {2, 3, 8})
        EXPECT_EQ(errorOf([&] { read(threads); }), one) << threads << " threads";
  }
  TestFolder folder;
  Scene scene;
};

TEST_F(ReadingKeyframes, GivesTheSameMeshesAndDigestForAnyNumberOfThreads) {
  const KeyframeSet one = read(1);
  // The digest is that of the files' bytes in the scene's order.
  Sha256 digest;
  for (int s = 0; s < kStructures; ++s)
    for (int k = 0; k < kInstants; ++k)
      digest.update(std::string_view(support::bytesOf(folder.path(name(s, k)))));
  EXPECT_EQ(one.sha256, digest.hex());
  for (const int threads : {2, 3, 8}) {
    const KeyframeSet other = read(threads);
    EXPECT_EQ(other.sha256, one.sha256);
    ASSERT_EQ(other.structures.size(), one.structures.size());
    for (std::size_t s = 0; s < kStructures; ++s)
      for (std::size_t k = 0; k < kInstants; ++k) {
        EXPECT_EQ(other.structures[s][k].mesh.positions, one.structures[s][k].mesh.positions);
        EXPECT_EQ(other.structures[s][k].mesh.triangles, one.structures[s][k].mesh.triangles);
      }
  }
}

TEST_F(ReadingKeyframes, TheFirstOfSeveralUnusableFilesIsNamed) {
  folder.write(name(3, 0), "v 1 2\n");
  folder.write(name(2, 7), "nonsense\nv 1 x 2\n");
  folder.write(name(2, 4), "");
  expectError(name(2, 4) + ": the file is empty");
}

TEST_F(ReadingKeyframes, AFaultOfAnEarlierStructureComesBeforeALaterUnusableFile) {
  TriangleMesh inward = sphere(2.1, 2);
  for (Triangle& t : inward.triangles) std::swap(t[1], t[2]);
  for (int k = 0; k < kInstants; ++k) folder.write(name(1, k), objText(inward));
  folder.write(name(2, 0), "");
  expectError("its faces look inward");
}

TEST_F(ReadingKeyframes, AnUnusableFileComesBeforeAFaultOfALaterStructure) {
  folder.write(name(1, 8), "");
  folder.write(name(3, 2), objText(sphere(2, 1)));  // other faces
  expectError(name(1, 8) + ": the file is empty");
}

TEST_F(ReadingKeyframes, AnErrorOfTheMotionIsThatOfTheFirstStructure) {
  for (const int s : {1, 3}) {
    TriangleMesh far = sphere(2, 2);
    for (Vec3d& p : far.positions) p.x += 2000;
    for (int k = 0; k < kInstants; ++k) folder.write(name(s, k), objText(far));
  }
  const auto make = [&](int threads) {
    return errorOf([&] { withThreads(threads, [&] { const MeshMotion motion(scene); }); });
  };
  const std::string one = make(1);
  EXPECT_NE(one.find(name(1, 0) + " reaches"), std::string::npos) << one;
  for (const int threads : {2, 8}) EXPECT_EQ(make(threads), one);
}

}  // namespace
}  // namespace echocine
