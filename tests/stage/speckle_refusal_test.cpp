// Speckle and artefacts that cannot be made are refused with one line.

#include <gtest/gtest.h>

#include "core/stop.h"
#include "support/scene_text.h"
#include "support/speckle_bed.h"

namespace echocine {
namespace {

using support::refusalOf;
using support::SceneText;

struct Wrong {
  std::string table, line, key, says;
};

const std::vector<Wrong> kWrong{
    {"speckle", "per_cell = 0", "speckle.per_cell", "0.1"},
    {"speckle", "per_cell = nan", "speckle.per_cell", "0.1"},
    {"speckle", "per_cell = 1e9", "speckle.per_cell", "accepted: "},
    {"speckle", "smoothing_mm = -1", "speckle.smoothing_mm", "accepted: "},
    {"speckle", "heterogeneity_db = -1", "speckle.heterogeneity_db", "accepted: "},
    {"speckle", "anisotropy_db = inf", "speckle.anisotropy_db", "accepted: "},
    {"speckle", "coherence = 1", "speckle.coherence", "accepted: "},
    {"artefacts", "persistence = 1", "artefacts.persistence", "accepted: "},
    {"artefacts", "haze = \"thick\"", "artefacts.haze", "accepted: "},
    {"artefacts", "haze_width_deg = 0", "artefacts.haze_width_deg", "accepted: "},
    {"artefacts", "reverberation_length_mm = 0", "artefacts.reverberation_length_mm", "accepted: "},
    {"artefacts", "clutter_length_mm = nan", "artefacts.clutter_length_mm", "accepted: "},
    {"artefacts", "window_width_mm = -3", "artefacts.window_width_mm", "accepted: "},
    {"artefacts", "dropout_db = -1", "artefacts.dropout_db", "accepted: "},
};

TEST(SpeckleRefusal, NumbersOutOfRangeNameTheirKeyInOneLine) {
  for (const Wrong& wrong : kWrong) {
    SCOPED_TRACE(wrong.table + ": " + wrong.line);
    SceneText scene = SceneText::oneBox("blood");
    scene.extra = "[" + wrong.table + "]\n" + (wrong.table == "speckle" ? "on = true\n" : "") +
                  wrong.line + "\n";
    const std::string message = refusalOf(scene.text(), "heart.toml");
    EXPECT_TRUE(message.starts_with("heart.toml:")) << message;
    EXPECT_NE(message.find(": " + wrong.key + ": "), std::string::npos) << message;
    EXPECT_NE(message.find(wrong.says), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(SpeckleRefusal, ACoherentShareIsANumberFromZeroUp) {
  for (const std::string share : {"-1", "nan", "inf", "\"all\""}) {
    SceneText scene;
    scene.addStructure("box", "blood", "\"box.obj\"", 1, "coherent_share = " + share);
    const std::string message = refusalOf(scene.text());
    EXPECT_NE(message.find(": structure.coherent_share: is "), std::string::npos) << message;
    EXPECT_NE(message.find("accepted: a number from 0 up"), std::string::npos) << message;
  }
}

TEST(SpeckleRefusal, APulseThatSpeckleCannotBeMadeOf) {
  SceneText scene = SceneText::oneBox("blood");
  scene.extra = "[speckle]\non = true\n";
  scene.probe["depth_mm"] = "8";
  EXPECT_EQ(refusalOf(scene.text()), "");
  scene.signal["pulse_cycles"] = "20";  // 6.2 mm in a picture of 6 mm
  EXPECT_NE(refusalOf(scene.text()).find("signal.pulse_cycles: makes a pulse of 6."),
            std::string::npos);
  scene.signal["pulse_cycles"] = "0";
  EXPECT_NE(refusalOf(scene.text()).find("signal.pulse_cycles: 0 excludes"), std::string::npos);
  scene.extra = "";  // what speckle alone needs
  EXPECT_EQ(refusalOf(scene.text()), "");
}

TEST(SpeckleRefusal, MoreScatterersThanMemoryIsMeantFor) {
  const Probe probe = support::speckleProbe(ProbeKind::phased, 128, 512, 0.005, 0.15);
  SpeckleSettings settings;
  settings.on = true;
  settings.per_cell = 100000;
  try {
    const Speckle speckle(probe, PointSpread(probe, 2), settings, support::OneGroup{});
    FAIL() << speckle.scatterers();
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("speckle.per_cell = 100000 needs over"),
              std::string::npos)
        << error.what();
  }
}

// A fine lattice about an apex far behind the face.
struct FineGroup : support::OneGroup {
  float block_m = 1e-3f;
  CubeLattice lattice() const override { return {{}, block_m}; }
};

TEST(SpeckleRefusal, AFarApexTakesTheBlocksOfItsSectorAlone) {
  Probe probe = support::speckleProbe(ProbeKind::curvilinear, 128, 512, 0.005, 0.1);
  probe.face_radius_m = 1;
  probe.first_angle_rad = -0.03;
  probe.last_angle_rad = 0.03;
  SpeckleSettings settings;
  settings.on = true;
  settings.per_cell = 0.1;
  FineGroup fine;
  fine.reach_m = 0;
  const std::size_t narrow = Speckle(probe, PointSpread(probe, 2), settings, fine).scatterers();
  EXPECT_GT(narrow, 1000u);
  probe.first_angle_rad = -0.6;
  probe.last_angle_rad = 0.6;
  const std::size_t wide = Speckle(probe, PointSpread(probe, 2), settings, fine).scatterers();
  EXPECT_GT(wide, 10 * narrow);
  EXPECT_LT(wide, 30 * narrow);
  fine.block_m = 1e-4f;
  try {
    const Speckle speckle(probe, PointSpread(probe, 2), settings, fine);
    FAIL() << speckle.scatterers();
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("probe.face_radius_mm"), std::string::npos)
        << error.what();
  }
}

TEST(SpeckleRefusal, AStopEndsTheSearchForBlocks) {
  const Probe probe = support::speckleProbe(ProbeKind::phased, 128, 512, 0.005, 0.15);
  SpeckleSettings settings;
  settings.on = true;
  int asked = 0;
  EXPECT_THROW(
      stoppable([&] { return ++asked > 20; },
                [&] { const Speckle made(probe, PointSpread(probe, 2), settings, FineGroup{}); }),
      JobError);
}

}  // namespace
}  // namespace echocine
