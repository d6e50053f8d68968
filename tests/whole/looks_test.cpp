// Looks: what they change, what they leave, and that frames stay functions of their instant.

#include <gtest/gtest.h>

#include <optional>
#include <set>
#include <string>
#include <variant>

#include "core/parallel.h"
#include "dataset/draws.h"
#include "dataset/spec.h"
#include "frame/simulator.h"
#include "plan/effect_plan.h"
#include "scene/looks.h"
#include "scene/names.h"
#include "scene/scene_json.h"
#include "support/loop_scene.h"

namespace echocine {
namespace {

using namespace support;

class Looks : public testing::Test {
 protected:
  Looks() { writeBallMeshes(folder_); }
  Scene sceneWith(const Lines& signal, const std::string& extra = "") const {
    SceneText text = ballScene(10);
    text.output["exr"] = "false";
    text.probe["samples"] = "256";
    text.signal = signal;
    text.extra = extra;
    return readScene(folder_.write("scene.toml", text.text()));
  }

 private:
  TempFolder folder_;
};

bool on(const Scene& scene, Effect effect) {
  return planEffects(scene).decision(effect).on;
}

constexpr Effect kArtefacts[] = {Effect::dropout,       Effect::acoustic_window, Effect::haze,
                                 Effect::reverberation, Effect::clutter,         Effect::noise};

TEST_F(Looks, PaperHasTheBytesOfARenderWithoutTheseEffects) {
  const Scene plain = sceneWith({}), paper = sceneWith({{"look", "\"paper\""}});
  Scene bare = plain;
  bare.speckle = SpeckleSettings{};
  bare.artefacts = ArtefactSettings{};
  for (const Effect effect : kArtefacts) EXPECT_FALSE(on(paper, effect));
  EXPECT_FALSE(on(paper, Effect::speckle) || on(paper, Effect::persistence));
  const Simulator one(plain), two(paper), three(bare);
  for (const double time_s : {0.1, 0.4}) {
    const Frame a = one.frame(time_s), b = two.frame(time_s), c = three.frame(time_s);
    EXPECT_EQ(a.intensities, b.intensities);
    EXPECT_EQ(a.image.pixels, b.image.pixels);
    EXPECT_EQ(a.image.pixels, c.image.pixels);
  }
}

TEST_F(Looks, TurnOnWhatTheyAreMadeOf) {
  const Scene clean = sceneWith({{"look", "\"clean\""}}),
              scanner = sceneWith({{"look", "\"scanner\""}});
  EXPECT_TRUE(on(clean, Effect::speckle) && on(scanner, Effect::speckle));
  EXPECT_TRUE(on(clean, Effect::heterogeneity));
  for (const Effect effect : kArtefacts) {
    EXPECT_FALSE(on(clean, effect));
    EXPECT_TRUE(on(scanner, effect));
  }
  EXPECT_TRUE(on(scanner, Effect::tgc));
}

TEST_F(Looks, KeysOfTheSceneWin) {
  const Scene scene =
      sceneWith({{"look", "\"scanner\""}, {"grey_gamma", "1.25"}, {"tgc", "\"perfect\""}},
                "[artefacts]\nhaze = false\nnoise_db = -41\n[speckle]\nper_cell = 5\n");
  EXPECT_EQ(scene.signal.grey_gamma, 1.25);
  EXPECT_EQ(scene.signal.tgc, Tgc::perfect);
  EXPECT_FALSE(scene.artefacts.haze);
  EXPECT_TRUE(scene.artefacts.noise);
  EXPECT_EQ(scene.artefacts.noise_db, -41);
  EXPECT_EQ(scene.speckle.per_cell, 5);
}

TEST_F(Looks, TheExaminersGainIsAddedToThatOfAnyLook) {
  const auto picture = [&](const Scene& scene) { return Simulator(scene).frame(0.1).image.pixels; };
  for (const char* look : {"\"paper\"", "\"scanner\"", "\"faint\""}) {
    const Scene plain = sceneWith({{"look", look}}),
                more = sceneWith({{"look", look}, {"examiner_gain_db", "3"}});
    Scene same = plain;
    same.signal.gain_db += 3;
    EXPECT_EQ(more.signal.gain_db, plain.signal.gain_db) << look;
    EXPECT_EQ(picture(more), picture(same)) << look;
    EXPECT_NE(picture(more), picture(plain)) << look;
  }
}

TEST_F(Looks, PoorerQualityHasMoreOfEveryArtefact) {
  const auto artefacts = [&](const char* quality) {
    return sceneWith({{"look", "\"scanner\""}, {"quality", quality}}).artefacts;
  };
  const ArtefactSettings good = artefacts("\"good\""), medium = artefacts("\"medium\""),
                         poor = artefacts("\"poor\"");
  for (const auto level : {&ArtefactSettings::haze_db, &ArtefactSettings::reverberation_db,
                           &ArtefactSettings::clutter_db, &ArtefactSettings::noise_db,
                           &ArtefactSettings::dropout_db}) {
    EXPECT_LT(good.*level, medium.*level);
    EXPECT_LT(medium.*level, poor.*level);
  }
  EXPECT_GT(good.window_width_m, poor.window_width_m);
  EXPECT_EQ(medium.noise_db, sceneWith({{"look", "\"scanner\""}}).artefacts.noise_db);
}

// Of all effects at once, persistence too.
TEST_F(Looks, AnyFrameAloneHasTheBytesOfTheLoopForAnyThreads) {
  const Scene scene = sceneWith({{"look", "\"scanner\""}, {"reference_intensity", "1e-4"}},
                                "[artefacts]\npersistence = 0.4\n");
  const Simulator loop(scene), alone(scene);
  std::vector<GreyImage> images;
  for (int i = 0; i < 5; ++i) images.push_back(loop.frame(0.1 * i).image);
  EXPECT_NE(images[3].pixels, images[4].pixels);
  withThreads(2, [&] {
    for (const int i : {4, 1}) EXPECT_EQ(alone.frame(0.1 * i).image.pixels, images[i].pixels);
  });
}

// But for what they trace: trabeculae, of which there are none here, and slices across the plane.
TEST_F(Looks, LeaveTheReceivedIntensitiesOfThePlaneAlone) {
  const auto received = [&](const char* look, std::optional<int> slices) {
    Scene scene = sceneWith({{"look", look}});
    if (slices) scene.accuracy.elevation_slices = *slices;
    scene.output.exr = true;
    scene.output.channels = {Channel::y, Channel::reflection};
    return Simulator(scene).frame(0.2).channels;
  };
  EXPECT_EQ(received("\"scanner\"", 1), received("\"paper\"", {}));
  EXPECT_EQ(received("\"scanner\"", {}), received("\"paper\"", 3));
  EXPECT_NE(received("\"scanner\"", {}), received("\"paper\"", {}));
}

TEST_F(Looks, ScannersDifferAndTakeQuality) {
  std::set<double> ranges, pulses, smoothings;
  for (const char* look : {"scanner", "smooth", "contrast", "sharp", "portable", "faint"}) {
    const std::string quoted = std::string("\"") + look + "\"";
    const Scene scene = sceneWith({{"look", quoted}});
    for (const Effect effect : kArtefacts) EXPECT_TRUE(on(scene, effect)) << look;
    EXPECT_EQ(scene.signal.tgc, Tgc::mean) << look;
    EXPECT_GT(sceneWith({{"look", quoted}, {"quality", "\"poor\""}}).artefacts.haze_db,
              scene.artefacts.haze_db)
        << look;
    ranges.insert(scene.signal.dynamic_range_db);
    pulses.insert(scene.signal.pulse_cycles);
    smoothings.insert(scene.speckle.smoothing_m);
  }
  EXPECT_EQ(ranges.size(), 6u);
  EXPECT_EQ(pulses.size(), 3u);
  EXPECT_EQ(smoothings.size(), 6u);
}

TEST_F(Looks, QualityIsOfScannersAlone) {
  SceneText text = SceneText::oneBox("blood");
  text.signal["quality"] = "\"good\"";
  EXPECT_NE(refusalOf(text.text()).find("quality"), std::string::npos);
  EXPECT_NE(refusalOf(text.text()).find("scanner"), std::string::npos);
}

TEST(LooksOfDatasets, AreAllDrawn) {
  std::string names;
  for (const Look look : scannerLooks()) names += "\"" + std::string(nameOf(look)) + "\", ";
  const dataset::Spec spec = dataset::parseSpec(
      "hearts = 60\nviews = [\"a4c\"]\n[scene.signal]\nlook = { choice = [" + names +
          "] }\nquality = { choice = [\"good\", \"medium\", \"poor\"] }\n",
      "spec.toml");
  std::set<std::string> drawn;
  for (int i = 0; i < 60; ++i) {
    const auto values = dataset::drawOf(spec, i, 0).valuesOf(0);
    drawn.insert(std::get<std::string>(values.at("scene.signal.look")));
  }
  EXPECT_EQ(drawn.size(), 6u);
}

}  // namespace
}  // namespace echocine
