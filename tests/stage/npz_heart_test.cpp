// A heart written as NumPy files is the heart written as OBJ files.

#include <gtest/gtest.h>

#include "frame/simulator.h"
#include "motion/surfaces/keyframe_set.h"
#include "output/heart_files.h"
#include "scene/scene_reader.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using support::TempFolder;

TEST(NpzHeart, HasTheMeshesAndTheEchoesOfTheObjFiles) {
  const TempFolder folder;
  HeartFiles wanted;
  wanted.keyframes = 5;
  writeHeart(wanted, folder / "obj");
  wanted.format = heart::MeshFormat::npz;
  writeHeart(wanted, folder / "npz");
  Scene obj = readScene(folder / "obj/scene.toml"), npz = readScene(folder / "npz/scene.toml");
  const KeyframeSet expected = readKeyframes(obj), set = readKeyframes(npz);
  ASSERT_EQ(set.structures.size(), expected.structures.size());
  std::size_t corners = 0;
  for (std::size_t s = 0; s < set.structures.size(); ++s) {
    ASSERT_EQ(set.structures[s].size(), expected.structures[s].size()) << obj.structures[s].name;
    for (std::size_t k = 0; k < set.structures[s].size(); ++k) {
      EXPECT_EQ(npz.structures[s].keyframes[k].phase, obj.structures[s].keyframes[k].phase);
      const TriangleMesh &a = set.structures[s][k].mesh, &b = expected.structures[s][k].mesh;
      EXPECT_EQ(a.positions, b.positions) << obj.structures[s].name << ' ' << k;
      EXPECT_EQ(a.triangles, b.triangles);
      EXPECT_EQ(a.tags, b.tags);
      corners += a.tags.vertices.size();
    }
  }
  EXPECT_GT(corners, 0u);
  for (Scene* scene : {&obj, &npz}) {
    scene->probe.lines = 16;
    scene->probe.samples = 128;
  }
  const Simulator from_obj(obj), from_npz(npz);
  for (const double time_s : {0.0, 0.31}) {
    const Frame a = from_obj.frame(time_s), b = from_npz.frame(time_s);
    EXPECT_EQ(a.intensities, b.intensities) << time_s;
  }
}

}  // namespace
}  // namespace echocine
