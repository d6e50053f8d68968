// A loop of beats that vary, of keyframes recorded at another heart rate, through the whole
// program.

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "motion/cycle/cardiac_clock.h"
#include "render/estimate.h"
#include "render/render.h"
#include "support/loop_scene.h"
#include "support/run_files.h"

namespace echocine {
namespace {

using namespace support;

SceneText variedScene() {
  SceneText text = ballScene(6);
  text.acquisition["beats"] = "2.5";
  text.acquisition["rr_variability"] = "0.15";
  text.acquisition["seed"] = "3";
  text.motion["keyframe_heart_rate_bpm"] = "80";
  text.output["png"] = "true";
  return text;
}

std::map<std::string, std::string> rendered(const TempFolder& folder, const SceneText& text,
                                            const std::string& name, int threads) {
  const Scene scene = readScene(writeBall(folder, text));
  renderLoop(scene, {.folder = folder / name, .threads = threads, .frames = {}}, {});
  return lastingFiles(folder / name);
}

TEST(VariedBeats, AnyNumberOfThreadsWritesTheSameFiles) {
  const TempFolder folder;
  const auto one = rendered(folder, variedScene(), "one", 1);
  EXPECT_EQ(one, rendered(folder, variedScene(), "two", 2));
  EXPECT_EQ(one, rendered(folder, variedScene(), "four", 4));
}

TEST(VariedBeats, TheManifestSaysBeatAndPhaseOfEachFrameAndThePlanCountsTheSame) {
  const TempFolder folder;
  (void)rendered(folder, variedScene(), "out", 2);
  const auto manifest = nlohmann::json::parse(bytesOf(folder / "out/manifest.json"));
  const Scene scene = readScene(folder / "scene.toml");
  const CardiacClock clock(scene);
  ASSERT_EQ(manifest["frames"].size(), static_cast<std::size_t>(clock.frameCount()));
  for (int i = 0; i < clock.frameCount(); ++i) {
    const auto& frame = manifest["frames"][static_cast<std::size_t>(i)];
    EXPECT_EQ(frame["beat"], clock.at(i).beat);
    EXPECT_EQ(frame["phase"], clock.at(i).phase);
  }
  EXPECT_EQ(manifest["frames"].back()["beat"], 2);
  EXPECT_EQ(manifest["scene"]["acquisition"]["seed"], 3);
  EXPECT_EQ(estimateLoop(scene, 1).frames, clock.frameCount());
}

TEST(VariedBeats, SeedWarpAndVariabilityEachChangeThePictures) {
  const TempFolder folder;
  const auto as_is = rendered(folder, variedScene(), "as_is", 2);
  SceneText seed = variedScene(), uniform = variedScene(), steady = variedScene();
  seed.acquisition["seed"] = "4";
  uniform.acquisition["time_warp"] = "\"uniform\"";
  steady.acquisition["rr_variability"] = "0";
  const std::string frame = "png/frame_0005.png";
  for (const auto& [name, text] :
       {std::pair("seed", seed), std::pair("uniform", uniform), std::pair("steady", steady)})
    EXPECT_NE(as_is.at(frame), rendered(folder, text, name, 2).at(frame)) << name;
}

}  // namespace
}  // namespace echocine
