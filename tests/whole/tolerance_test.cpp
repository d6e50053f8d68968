// --tolerance-db and --preset: the promise, its record, its repeatability, what contradicts it.

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>

#include "core/parallel.h"
#include "metrics/picture_error.h"
#include "scene/scene_reader.h"
#include "study/setting_run.h"
#include "study/study.h"
#include "study/tolerance.h"
#include "support/all_cases.h"
#include "support/loop_scene.h"
#include "support/run_program.h"
#include "support/view_loops.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

SceneText tolerantBall() {
  SceneText text = ballScene(9);
  text.probe["depth_mm"] = "110";
  text.motion["subdivision"] = "1";
  makeCoarse(text);
  return text;
}

class Tolerance : public ::testing::Test {
 protected:
  Tolerance() { writeBall(folder, tolerantBall()); }
  Outcome render(const std::string& more, const std::string& out = "out") {
    return renderScene(folder / "scene.toml", folder / out, more);
  }
  nlohmann::json manifest(const std::string& out = "out") const {
    return nlohmann::json::parse(bytesOf(folder / out / "manifest.json"));
  }
  void expectUnusable(const std::string& more, const std::string& part) {
    const Outcome outcome = render(more);
    EXPECT_EQ(outcome.code, 2) << more;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(folder / "out"));
  }
  TempFolder folder;
};

// The frames of a scene that are not looked at when a tolerance is kept, at the reference.
class OtherFrames {
 public:
  explicit OtherFrames(const Scene& scene) : scene_(scene) {
    const std::vector<FrameTime> probed = probeFrames(scene, kToleranceFrames);
    SettingRun reference(atPreset(scene, Preset::reference).scene, shelf_);
    white_ = reference.referenceIntensity(probed);
    const CardiacClock clock(scene);
    for (int i = 0; i < clock.frameCount(); ++i) {
      const FrameTime time = clock.at(i);
      if (std::none_of(probed.begin(), probed.end(),
                       [&](const FrameTime& p) { return p.phase == time.phase; }))
        frames_.push_back(
            {time, reference.pictures(std::span(&time, 1), white_, false).front().grey});
    }
  }

  // The worst RMS error of the chosen scene on them.
  double error(const AccuracyChoice& choice) {
    SettingRun chosen(choice.scene, shelf_);
    double worst = 0;
    for (const auto& [time, grey] : frames_)
      worst = std::max(
          worst, pictureError(chosen.pictures(std::span(&time, 1), white_, false).front().grey,
                              grey, scene_.signal.dynamic_range_db)
                     .rms_db);
    return worst;
  }

 private:
  Scene scene_;
  MotionShelf shelf_;
  double white_ = 1;
  std::vector<std::pair<FrameTime, std::vector<float>>> frames_;
};

// Chooses for each tolerance, and asserts that the other frames keep it.
template <typename AlsoExpect>
void expectKept(const Scene& scene, const std::vector<double>& tolerances_db,
                const AlsoExpect& also) {
  withThreads(2, [&] {
    OtherFrames others(scene);
    for (const double tolerance_db : tolerances_db) {
      const AccuracyChoice choice = chooseWithin(scene, tolerance_db, 2, {});
      const double worst = others.error(choice);
      EXPECT_LE(worst, tolerance_db) << choice.record.setting;
      std::printf("tolerance %.1f dB: %.3f dB on other frames: %s: %s\n", tolerance_db, worst,
                  choice.record.setting.c_str(), choice.record.reason.c_str());
      std::fflush(stdout);
      also(choice);
    }
  });
}

TEST_F(Tolerance, IsKeptOnFramesThatWereNotLookedAt) {
  // The choice is the cheapest of what was tried and stays within.
  expectKept(readScene(folder / "scene.toml"), casesOf<double>({0.5, 4.0, 0.1, 1.5}, 2),
             [](const AccuracyChoice& choice) {
               double chosen_ms = 0, cheapest_ms = 1e9;
               for (const AccuracyCandidate& c : choice.record.candidates) {
                 if (c.accepted) cheapest_ms = std::min(cheapest_ms, c.cost_ms);
                 if (c.setting == choice.record.setting) chosen_ms = c.cost_ms;
                 EXPECT_EQ(c.accepted,
                           c.error_db <= *choice.record.tolerance_db / kToleranceSafety);
               }
               EXPECT_EQ(chosen_ms, cheapest_ms);
             });
}

// Three hearts as the paper draws them, coarse, so that their reference is small: beams six times
// as wide and pulses six times as long as those that ship, and every fourth keyframe.
class ToleranceOfHeart : public ::testing::TestWithParam<Family> {
 protected:
  static Scene coarseHeart(Family family) {
    Scene scene = sceneOf(family, View::a4c);
    scene.probe.aperture_m /= 6;
    scene.signal.pulse_cycles *= 6;
    scene.speckle = {};
    scene.artefacts = {};
    scene.output.width = 200;
    scene.output.height = 150;
    scene.acquisition.frame_rate_hz = 8 * scene.acquisition.heart_rate_hz;
    scene.acquisition.beats = 1;
    for (Structure& structure : scene.structures) {
      std::vector<Keyframe> kept;
      for (std::size_t k = 0; k < structure.keyframes.size(); k += 4)
        kept.push_back(structure.keyframes[k]);
      structure.keyframes = kept;
    }
    return scene;
  }
};

TEST_P(ToleranceOfHeart, IsKeptOnFramesThatWereNotLookedAt) {
  if (GetParam() != Family::shipped && !realHeartsThere()) GTEST_SKIP() << "no ../shared/real";
  expectKept(coarseHeart(GetParam()), casesOf<double>({1.0, 0.5, 2.0, 3.0}, 1),
             [](const AccuracyChoice&) {});
}

INSTANTIATE_TEST_SUITE_P(EachFamily, ToleranceOfHeart, ::testing::ValuesIn(kFamilies),
                         [](const auto& param) {
                           std::string name = nameOf(param.param);
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

// Scenes of one's own, too large for every run: ECHOCINE_TOLERANCE_SCENES=a.toml:b.toml.
TEST(TolerancePromise, IsKeptOnScenesOfOnesOwn) {
  const char* list = std::getenv("ECHOCINE_TOLERANCE_SCENES");
  if (list == nullptr) GTEST_SKIP() << "ECHOCINE_TOLERANCE_SCENES is not set";
  std::istringstream files(list);
  for (std::string file; std::getline(files, file, ':');) {
    std::printf("%s:\n", file.c_str());
    expectKept(readScene(file), {0.1, 0.5, 1.0, 2.0, 3.0}, [](const AccuracyChoice&) {});
  }
}

TEST_F(Tolerance, GivesTheSameChoiceAndBytesInEveryRun) {
  ASSERT_EQ(render("--tolerance-db 1 --threads 1", "one").code, 0);
  ASSERT_EQ(render("--tolerance-db 1 --threads 2", "two").code, 0);
  nlohmann::json one = manifest("one"), two = manifest("two");
  EXPECT_EQ(one["files"], two["files"]);
  EXPECT_EQ(one["scene_sha256"], two["scene_sha256"]);
  for (nlohmann::json* m : {&one, &two})
    for (auto& c : (*m)["accuracy"]["candidates"]) c.erase("probe_ms");
  EXPECT_EQ(one["accuracy"], two["accuracy"]);
}

TEST_F(Tolerance, IsSaidOnStandardErrorAndKeptInTheManifest) {
  const Outcome outcome = runShell("%B render '" + (folder / "scene.toml").string() + "' -o '" +
                                   (folder / "out").string() + "' --tolerance-db 2");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("echocine: accuracy: probe.lines = "), std::string::npos);
  const nlohmann::json accuracy = manifest()["accuracy"];
  EXPECT_EQ(accuracy["tolerance_db"], 2);
  EXPECT_NE(outcome.err.find(accuracy["setting"].get<std::string>()), std::string::npos);
  EXPECT_NE(outcome.err.find(accuracy["reason"].get<std::string>()), std::string::npos);
  EXPECT_GT(accuracy["candidates"].size(), 2u);
  EXPECT_EQ(accuracy["candidates"][0]["error_db"], 0);  // the reference
  const std::string lines = std::to_string(manifest()["scene"]["probe"]["lines"].get<int>());
  EXPECT_TRUE(accuracy["setting"].get<std::string>().starts_with("probe.lines = " + lines));
}

TEST_F(Tolerance, OfTheSceneFileIsThatOfTheCommandLine) {
  ASSERT_EQ(render("--tolerance-db 2", "asked").code, 0);
  SceneText text = tolerantBall();
  text.accuracy["tolerance_db"] = "2.0";
  writeBall(folder, text);
  ASSERT_EQ(render("", "written").code, 0);
  EXPECT_EQ(manifest("asked")["files"], manifest("written")["files"]);
}

TEST_F(Tolerance, ResumesAsItBegan) {
  ASSERT_EQ(render("--tolerance-db 2 --frames=:4").code, 0);
  const std::string before = bytesOf(folder / "out/intensity/frame_0001.exr");
  ASSERT_EQ(render("--tolerance-db 2 --resume").code, 0);
  EXPECT_EQ(bytesOf(folder / "out/intensity/frame_0001.exr"), before);
  EXPECT_EQ(manifest()["frames"].size(), 9u);
  // Another tolerance is another scene.
  EXPECT_EQ(render("--preset reference --resume").code, 2);
}

TEST_F(Tolerance, PresetsRenderAndAreKeptInTheManifest) {
  for (const char* preset : {"draft", "standard", "fine", "reference"}) {
    ASSERT_EQ(render(std::string("--frames=:1 --preset ") + preset, preset).code, 0);
    EXPECT_EQ(manifest(preset)["accuracy"]["preset"], preset);
  }
  EXPECT_LT(manifest("draft")["scene"]["probe"]["lines"].get<int>(),
            manifest("reference")["scene"]["probe"]["lines"].get<int>());
  ASSERT_EQ(render("--frames=:1", "plain").code, 0);
  EXPECT_EQ(manifest("plain")["accuracy"]["setting"], "as written");
}

// An echo is as long as the pulse whatever a sample's length, so no preset touches the scene's
// gains.
TEST_F(Tolerance, PresetsLeaveReflectionGainsAlone) {
  const Scene scene = readScene(folder / "scene.toml");
  for (const Preset preset : {Preset::draft, Preset::reference}) {
    const Scene changed = atPreset(scene, preset).scene;
    for (std::size_t s = 0; s < scene.structures.size(); ++s)
      EXPECT_EQ(changed.structures[s].reflection_gain, scene.structures[s].reflection_gain);
  }
}

TEST_F(Tolerance, ContradictionsAreOneLine) {
  expectUnusable("--tolerance-db 0",
                 "--tolerance-db: 0 is not accepted: a number from 1e-06 to 1000");
  expectUnusable("--tolerance-db -1", "a number from 1e-06 to 1000");
  expectUnusable("--tolerance-db nan", "a number from 1e-06 to 1000");
  expectUnusable("--tolerance-db much", "--tolerance-db");
  expectUnusable("--preset best", "accepted: draft, standard, fine, reference");
  expectUnusable("--preset fine --tolerance-db 1", "excludes");
  SceneText text = tolerantBall();
  text.accuracy["tolerance_db"] = "1";
  writeBall(folder, text);
  expectUnusable("--preset fine", "tolerance_db: excludes --preset");
  text.accuracy["tolerance_db"] = "0";
  writeBall(folder, text);
  expectUnusable("", "tolerance_db");
}

TEST_F(Tolerance, AStopWhileItIsChosenIsAFailedJobThatWritesNothing) {
  const Scene scene = readScene(folder / "scene.toml");
  Monitor monitor;
  int asked = 0;
  monitor.keep_going = [&] { return ++asked < 3; };
  EXPECT_THROW(chooseWithin(scene, 0.5, 1, monitor), JobError);
}

}  // namespace
}  // namespace echocine
