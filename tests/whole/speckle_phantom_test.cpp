// A ball that moves in its own medium: only its speckle shows the motion.

#include <gtest/gtest.h>

#include "frame/simulator.h"
#include "metrics/block_match.h"
#include "metrics/statistics.h"
#include "motion/surfaces/mesh_motion.h"
#include "plan/loop_plan.h"
#include "scene/scene_reader.h"
#include "support/loop_scene.h"
#include "support/measured.h"

namespace echocine {
namespace {

class SpecklePhantom : public testing::Test {
 protected:
  // A ball of 15 mm radius, 6 cm deep, on a circle of 2 mm (across) by 3 mm (along).
  Scene movingBall(const std::string& medium, const std::string& speckle = "on = true") const {
    support::SceneText text;
    text.probe["lines"] = "256";
    text.probe["samples"] = "1024";
    text.probe["depth_mm"] = "100";
    text.acquisition["frame_rate_hz"] = "50";
    text.output["exr"] = "false";
    text.background = "soft_tissue";
    text.addStructure("ball", medium, "\"ball_*.obj\"");
    for (int i = 0; i < kKeyframes; ++i) {
      const Vec3d at = ballAt(static_cast<double>(i) / kKeyframes);
      support::writeObj(support::icosphere(3, 1.5).moved({100 * at.x, 0, 100 * at.z}),
                        folder_ / ("ball_" + std::to_string(i) + ".obj"));
    }
    text.extra = "[speckle]\n" + speckle + "\nsmoothing_mm = 0\n";
    return readScene(folder_.write("scene.toml", text.text()));
  }
  static constexpr int kKeyframes = 16;
  static Vec3d ballAt(double phase) {
    const double turn = 2 * std::numbers::pi * phase;
    return {0.002 * std::cos(turn), 0, 0.06 + 0.003 * std::sin(turn)};
  }

 private:
  support::TempFolder folder_;
};

TEST_F(SpecklePhantom, OneMediumShowsSpeckleThatTrackingFollows) {
  const Simulator simulator(movingBall("soft_tissue"));
  ASSERT_TRUE(simulator.plan().effects.speckle);
  EXPECT_FALSE(simulator.plan().effects.contrast);
  for (const std::string& warning : simulator.plan().warnings)
    EXPECT_EQ(warning.find("nothing can be seen"), std::string::npos) << warning;
  const Probe& probe = simulator.scene().probe;
  const auto framed = [&](double time_s) {
    Frame frame = simulator.frame(time_s);
    EXPECT_GT(*std::max_element(frame.greys.begin(), frame.greys.end()), 0.5f);
    std::vector<float> logs(frame.intensities.begin(), frame.intensities.end());
    for (float& v : logs) v = std::log(std::max(v, 1e-30f));
    return std::pair(std::move(logs), frame.time.phase);
  };
  const double pitch_rad = (probe.last_angle_rad - probe.first_angle_rad) / (probe.lines - 1);
  std::vector<double> along_mm, across_mm;
  for (const double time_s : {0.1, 0.32, 0.55, 0.86}) {
    const auto [before, from_phase] = framed(time_s);
    const auto [after, to_phase] = framed(time_s + 0.01);
    const auto plane = [&](const std::vector<float>& values) {
      return BlockPlane{.values = values, .lines = probe.lines, .samples = probe.samples};
    };
    const auto moved = [&](double phase) {  // centre of the surface, between keyframes
      SurfaceFrame surfaces;
      simulator.motion().frameAt(phase, surfaces, false);
      Vec3d middle;
      for (const Vec3f p : surfaces.positions_m[0]) middle = middle + toDouble(p);
      return (1.0 / static_cast<double>(surfaces.positions_m[0].size())) * middle;
    };
    const Vec3d middle = moved(from_phase), shift = moved(to_phase) - middle;
    for (const double x_m : {-0.005, 0.0, 0.005})
      for (const double z_m : {-0.005, 0.0, 0.005}) {
        const Vec3d at = middle + Vec3d{x_m, 0, z_m};
        const int line = static_cast<int>(
            std::lround((std::atan2(at.x, at.z) - probe.first_angle_rad) / pitch_rad));
        const int sample =
            static_cast<int>((std::hypot(at.x, at.z) - probe.min_depth_m) / probe.sampleSpacing());
        const double angle = probe.first_angle_rad + line * pitch_rad,
                     r = probe.min_depth_m + (sample + 0.5) * probe.sampleSpacing();
        const Vec3d to = Vec3d{r * std::sin(angle), 0, r * std::cos(angle)} + shift;
        const auto match = matchBlock(plane(before), plane(after), line, sample,
                                      {.half_lines = 10, .half_samples = 40});
        ASSERT_TRUE(match) << time_s;
        along_mm.push_back(
            1e3 * std::abs(match->samples * probe.sampleSpacing() - (std::hypot(to.x, to.z) - r)));
        across_mm.push_back(1e3 * r *
                            std::abs(match->lines * pitch_rad - (std::atan2(to.x, to.z) - angle)));
      }
  }
  EXPECT_LT(support::Largest("along", "mm")(quartilesOf(along_mm).third_quartile), 0.02);
  EXPECT_LT(support::Largest("across", "mm")(quartilesOf(across_mm).third_quartile), 0.06);
}

TEST_F(SpecklePhantom, WithoutSpeckleOneMediumShowsNothing) {
  const Simulator simulator(movingBall("soft_tissue", "on = false"));
  EXPECT_FALSE(simulator.plan().effects.speckle);
  EXPECT_FALSE(simulator.plan().effects.shows());
}

}  // namespace
}  // namespace echocine
