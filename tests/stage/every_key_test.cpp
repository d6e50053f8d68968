// The reference scene names every key, with the defaults that the program has.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/units.h"
#include "scene/scene_json.h"
#include "scene/scene_reader.h"
#include "support/paths.h"

namespace echocine {
namespace {

const std::filesystem::path kReference =
    std::filesystem::path(support::kSourceDir) / "examples/every_key/scene.toml";

TEST(EveryKey, ValuesThatAreCalledDefaultsAre) {
  const Scene reference = readScene(kReference);
  Scene defaults;  // as the structs have them
  const auto json = [](const Scene& scene, const char* part) {
    Scene copy = scene;
    copy.media = {Medium{}};
    copy.background = MediumId{};
    copy.structures.clear();
    return sceneJson(copy)[part];
  };
  for (const char* part :
       {"unit_volume_m3", "acquisition", "effects", "signal", "accuracy", "output"})
    EXPECT_EQ(json(reference, part), json(defaults, part)) << part;
  EXPECT_EQ(reference.motion.interpolation, defaults.motion.interpolation);
}

TEST(EveryKey, ProbeKeysThatAreLeftOutTakeTheReferencesValues) {
  const Scene reference = readScene(kReference);
  const Scene plain =
      readScene(std::filesystem::path(support::kSourceDir) / "examples/beating_heart/scene.toml");
  EXPECT_EQ(plain.probe.aperture_m, reference.probe.aperture_m);
  EXPECT_NEAR(plain.probe.focus_m, reference.probe.focus_m, 1e-12);
  EXPECT_EQ(plain.probe.min_depth_m, reference.probe.min_depth_m);
  EXPECT_EQ(reference.structures[0].reflection_gain, Structure{}.reflection_gain);
  EXPECT_EQ(reference.structures[0].reflection_exponent, Structure{}.reflection_exponent);
  EXPECT_EQ(reference.structures[0].coherent_share, Structure{}.coherent_share);
  EXPECT_EQ(reference.structures[0].repair.any(), Structure{}.repair.any());
}

}  // namespace
}  // namespace echocine
