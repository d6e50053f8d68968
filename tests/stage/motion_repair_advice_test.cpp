// What a refusal advises is tried: the repairs it names mend the mesh, and no fewer do.

#include "motion/repair/repair_advice.h"
#include "motion/surfaces/keyframe_set.h"
#include "tests/stage/nasty_meshes.h"
#include "tests/support/paths.h"

namespace echocine::motion_test {
namespace {

constexpr std::pair<const char*, bool Repairs::*> kWords[] = {
    {"\"weld\"", &Repairs::weld},
    {"\"drop-degenerate\"", &Repairs::drop_degenerate},
    {"\"orient\"", &Repairs::orient},
    {"\"split\"", &Repairs::split},
    {"\"fill-holes\"", &Repairs::fill_holes}};

// The repairs between "repair = [" and "]".
Repairs repairsIn(const std::string& message) {
  const std::size_t begin = message.find("repair = [");
  if (begin == std::string::npos) return {};
  const std::string list = message.substr(begin, message.find(']', begin) - begin);
  Repairs repairs;
  for (const auto& [word, asked] : kWords) repairs.*asked = list.find(word) != std::string::npos;
  return repairs;
}

std::string readingOf(const Scene& scene) {
  return errorOf([&] { readKeyframes(scene); });
}

struct Nasty {
  const char* name;
  TriangleMesh mesh;
  bool mendable = true;
};

std::vector<Nasty> nasties() {
  TriangleMesh flap = ball();
  flap.positions.push_back({3, 3, 3});
  flap = withFaces(flap, {{flap.triangles[0][0], flap.triangles[0][1], 258}});
  return {{"inside out", flipped(ball(), 1)},
          {"partly flipped", flipped(ball(), 5)},
          {"soup", soup(ball())},
          {"flipped soup", flipped(soup(ball()), 3)},
          {"soup with a hole", without(soup(ball()), 7, 1)},
          {"hole", without(ball(), 0, 64)},
          {"hole, partly flipped", flipped(without(ball(), 0, 64), 5)},
          {"fin", finned(ball())},
          {"fin in a soup with a hole", without(soup(finned(ball())), 7, 1)},
          {"a corner named twice", withFaces(ball(), {{3, 3, 5}})},
          {"a corner named twice in a soup", withFaces(soup(ball()), {{3, 3, 5}})},
          {"flap", flap},
          {"flap, inside out", flipped(flap, 1)},
          {"bow tie", bowTie()},
          {"sheet", without(octahedron(2), 1, 7), false},
          {"one side only", moebius(), false}};
}

TEST(MotionRepairAdvice, WhatARefusalNamesMendsIt) {
  for (const Nasty& nasty : nasties()) {
    SCOPED_TRACE(nasty.name);
    const TestFolder folder;
    Scene scene = sceneOf(structureOf({folder.write("a.obj", objText(nasty.mesh))}));
    const std::string refusal = readingOf(scene);
    EXPECT_NE(refusal, "no error");
    EXPECT_EQ(refusal.find('\n'), std::string::npos);
    const Repairs named = repairsIn(refusal);
    EXPECT_EQ(named.any(), nasty.mendable) << refusal;
    if (!named.any()) continue;
    scene.structures[0].repair = named;
    EXPECT_EQ(readingOf(scene), "no error") << refusal;
    for (const auto& [word, asked] : kWords) {  // none of the words is idle
      if (!(named.*asked)) continue;
      scene.structures[0].repair = named;
      scene.structures[0].repair.*asked = false;
      EXPECT_NE(readingOf(scene), "no error") << refusal;
    }
  }
}

// Asking for what does not help is answered with what does.
TEST(MotionRepairAdvice, AWrongRepairIsAnsweredWithTheRightOne) {
  const TestFolder folder;
  Scene scene = sceneOf(structureOf({folder.write("a.obj", objText(without(ball(), 0, 64)))}));
  scene.structures[0].repair = kWeld;
  const std::string refusal = readingOf(scene);
  EXPECT_NE(refusal.find("repair = [\"fill-holes\"], or membrane = true"), std::string::npos)
      << refusal;
}

// Every keyframe counts: what mends the first alone is not advised.
TEST(MotionRepairAdvice, IsTriedOnAllKeyframes) {
  const TestFolder folder;
  TriangleMesh mirrored = flipped(ball(), 5);
  for (Vec3d& p : mirrored.positions) p.x = -p.x;
  const Scene scene = sceneOf(structureOf({folder.write("a.obj", objText(flipped(ball(), 5))),
                                           folder.write("b.obj", objText(mirrored))}));
  EXPECT_FALSE(repairsIn(readingOf(scene)).any());
}

// Three keyframes of 8 faces are 24 a trial, and orient is the third word that is tried.
TEST(MotionRepairAdvice, OfLargeMeshesIsNotTriedForLong) {
  const TestFolder folder;
  const auto file = folder.write("a.obj", objText(flipped(octahedron(2), 3)));
  const Structure structure = structureOf({file, file, file});
  EXPECT_FALSE(shortestRepair(structure, 0.01, 3 * 24 - 1));
  ASSERT_TRUE(shortestRepair(structure, 0.01, 3 * 24));
  EXPECT_EQ(repairWords(*shortestRepair(structure, 0.01)), "repair = [\"orient\"]");
}

TEST(MotionRepairAdvice, RealMeshesCloseWithWhatTheirRefusalNames) {
  const std::filesystem::path folder =
      std::filesystem::path(support::kSharedDir) / "real/robustness";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "needs " << folder;
  // mm^3: what drop-degenerate and all repairs together leave of each.
  const std::pair<const char*, double> cases[] = {
      {"cardiomesh_LV4396_nonmanifold.obj", 68220},
      {"slicerheart_marker_open_nonmanifold.obj", 143892}};
  for (const auto& [file, volume] : cases) {
    SCOPED_TRACE(file);
    Scene scene = sceneOf(structureOf({folder / file}));
    scene.motion.mesh_unit_m = 1e-3;
    const std::string refusal = readingOf(scene);
    std::vector<Repairs> plans{repairsIn(refusal),
                               {.weld = true, .split = true, .fill_holes = true}};
    EXPECT_TRUE(plans.front().any()) << refusal;
    for (const Repairs& plan : plans) {
      scene.structures[0].repair = plan;
      EXPECT_EQ(readingOf(scene), "no error") << refusal;
      const KeyframeSet set = readKeyframes(scene);
      EXPECT_EQ(leakCount(set.structures[0][0].mesh.triangles), 0u);
      EXPECT_NEAR(signedVolume(set.structures[0][0].mesh), volume, 0.01 * volume);
    }
  }
}

}  // namespace
}  // namespace echocine::motion_test
