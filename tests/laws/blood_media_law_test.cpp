// Which media flow: by the law of their backscatter or by what their file states, never by name.

#include <gtest/gtest.h>

#include <cmath>

#include "frame/simulator.h"
#include "support/scene_text.h"

namespace echocine::blood_media_law {
namespace {

// A ball of the medium that moves by 4 mm, and how many of its samples have a displacement.
struct Moved {
  int samples = 0, known = 0;
};

Moved moved(const std::string& medium, const std::string& keys) {
  support::SceneText text;
  text.motion = {{"mesh_unit", "\"mm\""}, {"interpolation", "\"linear\""}};
  text.media = "[media." + medium + "]\ndensity_kg_m3 = 1060\nsound_speed_m_s = 1584\n" +
               "attenuation_db_cm_mhz = 0.2\n" + keys + "\n";
  text.addStructure("ball", medium, "[\"ball_0\", \"ball_1\"]");
  const auto at = [](double x_mm) {
    const support::Mesh mesh = support::icosphere(3, 20).moved({x_mm, 0, 60});
    return std::make_shared<const TriangleMesh>(TriangleMesh{mesh.points, mesh.triangles, {}, {}});
  };
  Scene scene = parseScene(text.text(), "scene.toml", {{"ball_0", at(0)}, {"ball_1", at(4)}});
  scene.output.channels = {Channel::structure, Channel::displacement_lateral};
  const Frame frame = Simulator(scene).frame(0.4);
  Moved result;
  for (std::size_t i = 0; i < frame.truth->sample_ids.size(); ++i) {
    if (frame.truth->sample_ids[i] != 1) continue;
    ++result.samples;
    result.known += !std::isnan(frame.truth->motion.displacement_mm[0][i]);
  }
  return result;
}

const std::string kBlood =
    "backscatter = { kind = \"blood\", hematocrit = 0.45, cell_radius_um = 2.75, "
    "cell_density_kg_m3 = 1092, cell_compressibility_cm2_dyn = 34.1e-12 }\n";
const std::string kTissue =
    "backscatter = { kind = \"tissue\", velocity_variation = 0.004, correlation_length_um = 30 }\n";
const std::string kFixed = "backscatter = { kind = \"fixed\", per_cm_sr = 1e-5 }\n";

TEST(BloodMediaLaw, WhatFlowsHasNoDisplacement) {
  for (const auto& [medium, keys] : {std::pair<std::string, std::string>{"lumen", kBlood},
                                     {"contrast", kFixed + "blood = true"}}) {
    const Moved ball = moved(medium, keys);
    EXPECT_GT(ball.samples, 30) << medium;
    EXPECT_EQ(ball.known, 0) << medium;
  }
}

TEST(BloodMediaLaw, WhatDoesNotFlowHas) {
  for (const auto& [medium, keys] : {std::pair<std::string, std::string>{"bloodless_scar", kTissue},
                                     {"blood_clot", kBlood + "blood = false"},
                                     {"blood_pool_phantom", kFixed}}) {
    const Moved ball = moved(medium, keys);
    EXPECT_GT(ball.samples, 30) << medium;
    EXPECT_EQ(ball.known, ball.samples) << medium;
  }
}

}  // namespace
}  // namespace echocine::blood_media_law
