// The heart that comes with the project is the one that the program makes.

#include "output/heart_files.h"
#include "motion/heart/heart_scene.h"

#include <gtest/gtest.h>

#include "support/paths.h"
#include "support/recorded_heart.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

TEST(HeartFiles, TheExampleIsWhatDefaultsGive) {
  const RecordedHeart& made = recordedHeart({}, HeartFiles{}.keyframes);
  const fs::path data = fs::path(support::kDataDir) / "beating_heart";
  std::size_t meshes = 0;
  for (const heart::RecordedPart& part : made.recording.parts)
    for (std::size_t k = 0; k < part.control_m.size(); ++k, ++meshes) {
      const std::string name = heart::meshName(part, k);
      ASSERT_TRUE(bytesOf(data / name) == heartMesh(part, k)) << data / name;
    }
  const auto is_mesh = [](const fs::directory_entry& entry) {
    return entry.path().extension() == ".obj";
  };
  EXPECT_EQ(std::count_if(fs::directory_iterator(data), fs::directory_iterator(), is_mesh),
            static_cast<std::ptrdiff_t>(meshes));
  HeartFiles defaults;
  defaults.parameters = made.parameters;
  EXPECT_EQ(bytesOf(fs::path(support::kSourceDir) / "examples/beating_heart/scene.toml"),
            heart::sceneText(defaults.view, defaults.parameters, made.recording,
                             "../../data/beating_heart/"));
}

}  // namespace
}  // namespace echocine
