// A patient's heart against two strangers' echo videos, both apical four-chamber: the view that
// shows what they show has to come out nearer than one that does not.

#include <gtest/gtest.h>

#include "compare/compare.h"
#include "core/parallel.h"
#include "core/units.h"
#include "render/render.h"
#include "support/all_cases.h"
#include "support/patient_scene.h"
#include "support/run_program.h"
#include "support/temp_folder.h"

namespace echocine::compare {

using namespace echo;
namespace {

using namespace support;

const std::filesystem::path kVideos = std::filesystem::path(kSharedDir) / "real/videos";

class PatientAgainstVideos : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(kVideos) || !std::filesystem::is_directory(patientMeshes()))
      GTEST_SKIP() << "the videos or meshes in " << kSharedDir << " are absent";
  }
  std::filesystem::path render(const char* name, void (*pose)(SceneText&)) {
    SceneText text = patientScene();
    pose(text);
    text.output = {{"width", "640"}, {"height", "480"}};
    const Scene scene = parseScene(text.text(), folder / "scene.toml");
    renderLoop(scene, {.folder = folder / name, .threads = 2, .frames = {}}, {});
    return folder / name;
  }
  static Comparison compareWith(const std::filesystem::path& synthetic, const char* video,
                                SideOptions side = {}) {
    Comparison c;
    CompareOptions options;
    options.synthetic = synthetic;
    options.real = kVideos / video;
    options.real_side = std::move(side);
    withThreads(2, [&] { c = compareLoops(options); });
    std::printf(
        "%s, %s: D %.4f (%.4f as placed), shift %.1f, %.1f px, turn %.1f deg, NCC %.3f, MI %.3f, "
        "time %.3f\n",
        synthetic.filename().c_str(), video, c.discrepancy, c.discrepancy_as_placed,
        c.space.placement.shift_x_px, c.space.placement.shift_y_px,
        degreesFromRadians(c.space.placement.rotation_rad), c.mean_after.ncc,
        c.mean_after.mutual_information, c.time.correlation);
    return c;
  }
  static std::vector<const char*> videos() {
    return casesOf<const char*>({"a4c_sonosite_30f.dcm", "a4c_echotracker_45f.mp4"}, 1);
  }
  TempFolder folder;
};

// Margins are half of what was measured (README).
TEST_F(PatientAgainstVideos, TheViewThatTheyShowIsNearestToBoth) {
  const auto right = render("apical", poseApical), wrong = render("short_axis", poseShortAxis);
  for (const char* video : videos()) {
    const Comparison apical = compareWith(right, video), across = compareWith(wrong, video);
    EXPECT_LT(apical.discrepancy, across.discrepancy - 0.04) << video;
    // What moves was not asked where the view lies, and agrees.
    EXPECT_GT(apical.time.correlation, across.time.correlation) << video;
  }
}

// The heart that ships, by the program as a user runs it. Its four-chamber view lies nearer than
// the short axis, which no probe at the apex sees.
TEST_F(PatientAgainstVideos, TheShippedHeartsFourChamberViewIsNearestToBoth) {
  const auto rendered = [&](const std::string& view) {
    const std::string heart = (folder / ("heart_" + view)).string(),
                      loop = (folder / view).string();
    EXPECT_EQ(runShell("%B heart --quiet --look paper --view " + view + " -o '" + heart + "'").code,
              0);
    EXPECT_EQ(renderScene(heart + "/scene.toml", loop).code, 0);
    return loop;
  };
  const auto right = rendered("a4c"), wrong = rendered("psax-mid");
  for (const char* video : videos())
    EXPECT_LT(compareWith(right, video).discrepancy, compareWith(wrong, video).discrepancy - 0.07)
        << video;
}

}  // namespace
}  // namespace echocine::compare
