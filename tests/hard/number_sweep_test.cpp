// Every number of a scene at values that no physics has: a finite picture, or a refusal that names
// the key and leaves no folder.

#include <gtest/gtest.h>

#include <sstream>

#include "core/error.h"
#include "render/render.h"
#include "scene/scene_reader.h"
#include "support/all_cases.h"
#include "support/meshes.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace support;

// What no probe, beam or medium changes.
const std::string kLoop = R"(
background = "soft_tissue"
unit_volume_cm3 = 1.0
[acquisition]
heart_rate_bpm = 65.0
frame_rate_hz = 5.0
rolling_share = 0.5
beats = 1.0
rr_variability = 0.1
seed = 1
[motion]
mesh_unit = "cm"
subdivision = 0
keyframe_heart_rate_bpm = 65.0
end_systole_phase = 0.33
keyframe_phases = [0.0, 0.4]
[[structure]]
name = "ball"
medium = "MEDIUM"
priority = 3
keyframes = ["ball_0.obj", "ball_1.obj"]
reflection_gain = 1.0
reflection_exponent = 2.0
coherent_share = 1.0
[output]
channels = ["Y", "unattenuated.Y", "attenuation.A", "reflection.Y", "backscatter.Y", "display.Y"]
report = false
width = 64
height = 48
jpeg_quality = 90
)";

const std::string kMediaAndProbe = R"(
[media.one]
density_kg_m3 = 1097
sound_speed_m_s = 1584
attenuation_db_cm_mhz = 0.52
attenuation_exponent = 1.0
[media.one.backscatter]
kind = "fixed"
per_cm_sr = 1.6e-5
[media.two]
density_kg_m3 = 1060
sound_speed_m_s = 1570
attenuation_db_cm_mhz = 0.2
[media.two.backscatter]
kind = "blood"
hematocrit = 0.45
cell_radius_um = 2.75
cell_density_kg_m3 = 1092
cell_compressibility_cm2_dyn = 3.41e-11
[media.three]
density_kg_m3 = 1060
sound_speed_m_s = 1570
attenuation_db_cm_mhz = 0.2
[media.three.backscatter]
kind = "tissue"
velocity_variation = 0.02
correlation_length_um = 40
[probe]
apex = [0.1, 0, 0]
axis = [0, 0, 1]
lateral = [1, 0, 0]
min_depth_mm = 2
depth_mm = 120
frequency_mhz = 2.5
lines = 8
samples = 48
)";

const std::string kFocused = R"(
aperture_mm = 20
focus_mm = 60
[signal]
pulse_cycles = 2.0
dynamic_range_db = 60.0
reference_percentile = 99.5
grey_gamma = 1.0
[accuracy]
rays_per_beam = 1
elevation_slices = 3
refraction_tolerance_beam_widths = 0.5
rolling_lines = 16
)";
const std::string kRays = R"(
aperture_mm = 20
focus_mm = 60
elevation_aperture_mm = 13
elevation_focus_mm = 80
[signal]
reference_intensity = 1e-6
tgc = "nominal"
tgc_nominal_db_cm_mhz = 0.41
gain_db = 0.0
interface_gain_db = 0.0
interface_limit_db = -55.0
[accuracy]
rays_per_beam = 4
)";
const std::string kSpeckle = R"(
[trabeculae]
height_mm = 1.0
scale_mm = 5.0
seed = 1
[speckle]
on = true
seed = 1
per_cell = 0.2
smoothing_mm = 0.7
tissue_time_ms = 0.0
blood_time_ms = 10.0
heterogeneity_db = 4.0
heterogeneity_fine_mm = 1.2
heterogeneity_layer_mm = 1.0
heterogeneity_coarse_mm = 4.0
heterogeneity_seed = 1
anisotropy_db = 10.0
helix_angle_deg = 60.0
)";
const std::string kArtefacts = R"(
[artefacts]
dropout = true
dropout_db = 12.0
acoustic_window = true
window_width_mm = 24.0
window_offset_mm = 0.0
window_depth_mm = 12.0
window_shadow_db = 30.0
shading = true
shading_db = 3.0
lung = true
lung_db = -3.0
lung_length_mm = 20.0
haze = true
haze_db = -24.0
haze_width_deg = 7.0
reverberation = true
reverberation_db = -27.0
reverberation_length_mm = 6.0
clutter = true
clutter_db = -12.0
clutter_length_mm = 6.0
clutter_width_deg = 9.0
clutter_seed = 1
noise = true
noise_db = -55.0
noise_seed = 1
persistence = 0.3
)";
const std::string kFixed = R"(
[signal]
beam_width = "fixed"
beam_width_mm = 2.0
edge_enhancement = 0.5
near_gain_db = -10.0
near_gain_depth_mm = 30.0
tgc = "table"
tgc_table_mm_db = [[1, 0], [160, 40]]
reference_intensity = 1e-6
)";

// One value in so many of each key, another one for the next key.
const int kStep = allCases() ? 1 : 4;

const std::string kValues =
    "5e-324 1e-300 -0.0 0.0 -1.0 1e-7 0.001 1000.0 1e5 1e6 1e9 1e60 1e308 nan inf -inf "
    "9223372036854775807 -1";

class NumberSweep : public ::testing::Test {
 protected:
  NumberSweep() {
    writeObj(icosphere(1, 2.5).moved({0.3, 0.2, 6}), folder / "ball_0.obj");
    writeObj(icosphere(1, 2.0).moved({0.3, 0.2, 6}), folder / "ball_1.obj");
  }

  // What a run with the text says; empty: it ended well.
  std::string outcome(const std::string& text, bool& folder_left) {
    const std::filesystem::path out = folder / "out";
    std::filesystem::remove_all(out);
    std::string said;
    try {
      RenderOptions options;
      options.folder = out;
      options.threads = 1;
      options.frames = std::pair(0, 1);
      renderLoop(parseScene(text, folder / "scene.toml"), options, {});
    } catch (const SceneError& error) {
      said = error.what();
    }
    folder_left = std::filesystem::exists(out);
    return said;
  }

  // Each number of `varied` in turn, the first of a list, in a scene of both.
  void sweep(const std::string& kept, const std::string& varied) {
    const std::string text = kept + varied;
    bool left = false;
    ASSERT_EQ(outcome(text, left), "");
    std::istringstream lines(varied);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t equals = line.find(" = ");
      if (equals == std::string::npos) continue;
      const std::size_t from = line.find_first_not_of("[", equals + 3);
      if (line.find_first_of("0123456789", from) != from) continue;
      const std::size_t to = std::min(line.find_first_of(",]", from), line.size());
      const std::string key = line.substr(0, equals);
      ++keys;
      std::istringstream values(kValues);
      int index = 0;
      for (std::string value; values >> value;) {
        if ((index++ + keys) % kStep != 0) continue;
        std::string changed = line;
        changed.replace(from, to - from, value);
        std::string whole = text;
        whole.replace(whole.find("\n" + line + "\n") + 1, line.size(), changed);
        SCOPED_TRACE(changed);
        std::string said;
        EXPECT_NO_THROW(said = outcome(whole, left)) << changed;
        ++runs;
        if (said.empty()) {
          ++accepted;
          continue;
        }
        EXPECT_NE(said.find(key), std::string::npos) << said;
        EXPECT_FALSE(left) << said;
      }
    }
  }

  void expectBothEnds(int least_runs, int least_accepted) {
    RecordProperty("runs", runs);
    RecordProperty("accepted", accepted);
    EXPECT_GT(runs, least_runs / kStep);
    EXPECT_GT(accepted, least_accepted / kStep);
  }
  static std::string with(std::string text, const std::string& medium) {
    return text.replace(text.find("MEDIUM"), 6, medium);
  }

  TempFolder folder;
  int keys = 0, runs = 0, accepted = 0;
};

TEST_F(NumberSweep, EveryKeyOfALoopIsAPictureOrARefusalThatNamesIt) {
  sweep("", with(kLoop, "one") + kMediaAndProbe + "sector_deg = 70\n" + kFocused);
  expectBothEnds(700, 100);
}

TEST_F(NumberSweep, EveryKeyOfBloodAndSeveralRays) {
  sweep(with(kLoop, "two"), kMediaAndProbe + "sector_deg = 70\n" + kRays);
  expectBothEnds(400, 50);
}

TEST_F(NumberSweep, EveryKeyOfArtefacts) {
  sweep(with(kLoop, "one") + kMediaAndProbe + "sector_deg = 70\n" + kFocused, kArtefacts);
  expectBothEnds(200, 25);
}

TEST_F(NumberSweep, EveryKeyOfSpeckle) {
  sweep(with(kLoop, "one") + kMediaAndProbe + "sector_deg = 70\n" + kFocused, kSpeckle);
  expectBothEnds(150, 20);
}

TEST_F(NumberSweep, EveryKeyOfTissueAndACurvilinearProbe) {
  sweep(with(kLoop, "three"),
        kMediaAndProbe + "kind = \"curvilinear\"\nsector_deg = 60\nface_radius_mm = 40\n" + kFixed);
  expectBothEnds(400, 50);
}

TEST_F(NumberSweep, EveryKeyOfALinearProbe) {
  sweep(with(kLoop, "two"), kMediaAndProbe + "kind = \"linear\"\nwidth_mm = 40\n" + kFocused);
  expectBothEnds(400, 50);
}

}  // namespace
}  // namespace echocine
