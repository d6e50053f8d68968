// A real patient's heart in the apical four-chamber view, rendered as a whole loop.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "motion/surfaces/mesh_motion.h"
#include "render/render.h"
#include "support/cine_frames.h"
#include "support/exr_planes.h"
#include "support/patient_scene.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace support;

const std::filesystem::path kMeshes = patientMeshes();

// mL, as published with the meshes.
constexpr std::array<double, 25> kLeft{
    174.5, 169.4, 156.2, 140.2, 121.8, 107.0, 96.8,  82.0,  79.0,  72.0,  77.5,  80.3, 88.1,
    104.3, 119.2, 135.7, 144.8, 150.2, 150.1, 147.6, 146.1, 149.1, 154.6, 170.1, 179.0};
constexpr std::array<double, 25> kRight{
    170.1, 165.3, 154.0, 141.8, 129.0, 114.2, 101.6, 87.7,  82.7,  76.7,  77.6,  78.2, 82.0,
    99.3,  118.0, 122.2, 128.5, 133.0, 135.3, 136.2, 142.0, 146.9, 158.2, 167.0, 167.8};

class Patient : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(kMeshes)) GTEST_SKIP() << kMeshes << " is absent";
    scene = readScene(folder.write("scene.toml", patientScene().text()));
  }
  std::vector<double> leftVolumes(int phases) const {
    const MeshMotion motion(scene);
    SurfaceFrame frame;
    std::vector<double> ml;
    for (int i = 0; i < phases; ++i) {
      motion.frameAt(static_cast<double>(i) / phases, frame);
      ml.push_back(1e6 * enclosedVolume(motion.surfaces()[1], frame.positions_m[1]));
    }
    return ml;
  }
  TempFolder folder;
  Scene scene;
};

void expectVolumes(const nlohmann::json& list, const std::array<double, 25>& published,
                   const char* name) {
  ASSERT_EQ(list.size(), 25u) << name;
  double worst = 0;
  for (std::size_t i = 0; i < 25; ++i) {
    EXPECT_NEAR(list[i]["phase"].get<double>(), static_cast<double>(i) / 25, 1e-12);
    worst = std::max(worst, std::abs(list[i]["volume_ml"].get<double>() / published[i] - 1));
  }
  EXPECT_LT(worst, 0.01) << name;
  std::printf("%s: volumes of 25 keyframes within %.3f %% of the published ones\n", name,
              100 * worst);
}

TEST_F(Patient, TheLoopHoldsThePublishedVolumesAndAllThreeMedia) {
  const RenderSummary summary =
      renderLoop(scene, {.folder = folder / "out", .threads = 2, .frames = {}}, {});
  EXPECT_EQ(summary.frames_done, 25);
  EXPECT_EQ(cineFrames(folder / "out/cine.avi"), 25);
  const nlohmann::json manifest = nlohmann::json::parse(bytesOf(folder / "out/manifest.json"));
  expectVolumes(manifest.at("keyframe_volumes").at("lv"), kLeft, "lv");
  expectVolumes(manifest.at("keyframe_volumes").at("rv"), kRight, "rv");
  const ExrPlane media = exrPlane(folder / "out/intensity/frame_0000.exr", "medium.id");
  for (std::uint32_t id = 0; id < scene.media.size(); ++id)
    EXPECT_GT(std::count(media.bits.begin(), media.bits.end(), id), 2000) << scene.media[id].name;
}

TEST_F(Patient, TheLeftVentricleIsOnTheRightAndItsApexNearTheProbe) {
  const MeshMotion motion(scene);
  SurfaceFrame frame;
  motion.frameAt(0, frame);
  const auto mean = [&](std::size_t s) {
    Vec3d sum{};
    for (const Vec3f p : frame.positions_m[s]) sum = sum + toDouble(p);
    return (1.0 / static_cast<double>(frame.positions_m[s].size())) * sum;
  };
  EXPECT_GT(mean(1).x, mean(2).x + 0.02);
  float nearest = 1;
  for (const Vec3f p : frame.positions_m[1]) nearest = std::min(nearest, p.z);
  EXPECT_NEAR(nearest, 0.02, 1e-3);
}

// The data have a shallow dip in diastasis at keyframe 20 besides end-systole at keyframe 9; the
// curve between keyframes must not add another.
TEST_F(Patient, InterpolationAddsNoMinimumToTheVolumeCurve) {
  const std::vector<double> ml = leftVolumes(200);
  std::vector<int> minima;
  for (int i = 0; i < 200; ++i)
    if (ml[static_cast<std::size_t>(i)] < ml[static_cast<std::size_t>((i + 199) % 200)] &&
        ml[static_cast<std::size_t>(i)] <= ml[static_cast<std::size_t>((i + 1) % 200)])
      minima.push_back(i);
  ASSERT_EQ(minima.size(), 2u);
  EXPECT_NEAR(minima[0] / 8.0, 9, 1);
  EXPECT_NEAR(minima[1] / 8.0, 20, 1);
  const double low = *std::min_element(ml.begin(), ml.end()),
               high = *std::max_element(ml.begin(), ml.end());
  EXPECT_EQ(ml[static_cast<std::size_t>(minima[0])], low);
  EXPECT_GT(low, 0.97 * 72.0);
  EXPECT_LT(high, 1.03 * 179.0);
  std::printf("left ventricle %.1f mL to %.1f mL, smallest at phase %.3f\n", high, low,
              minima[0] / 200.0);
}

}  // namespace
}  // namespace echocine
