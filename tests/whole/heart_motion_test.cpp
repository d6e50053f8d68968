// The parametric heart between its keyframes, read back as any scene is: no triangle inverts.

#include <gtest/gtest.h>

#include "motion/mesh/surface_measure.h"
#include "motion/surfaces/motion_warnings.h"
#include "scene/scene_reader.h"
#include "support/all_cases.h"
#include "support/paths.h"
#include "support/recorded_heart.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace support;

const int kFrames = allCases() ? 200 : 60;  // of a beat
// Of a leaflet's area, midway between a keyframe where it is closed and one where it is open: a
// straight path from one to the other is shorter than the leaflet. Our choice.
constexpr double kLeastLeaflet = 0.75;

Scene sceneFrom(const std::filesystem::path& file) {
  Scene scene = readScene(file);
  scene.acquisition.frame_rate_hz = kFrames * scene.acquisition.heart_rate_hz;
  return scene;
}

std::vector<Vec3d> doubleAreas(const SurfaceTopology& surface, const std::vector<Vec3f>& points) {
  std::vector<Vec3d> areas;
  for (const Triangle& t : surface.triangles) areas.push_back(doubleArea(t, points));
  return areas;
}

// Triangles of a frame that look away from where the keyframes beside it, blended, look.
int inverted(const std::vector<Vec3d>& now, const std::vector<Vec3d>& left,
             const std::vector<Vec3d>& right, double fraction) {
  int count = 0;
  for (std::size_t i = 0; i < now.size(); ++i)
    count += dot(now[i], (1 - fraction) * left[i] + fraction * right[i]) <= 0 ? 1 : 0;
  return count;
}

double sizeOf(const std::vector<Vec3d>& double_areas) {
  double sum = 0;
  for (const Vec3d area : double_areas) sum += 0.5 * length(area);
  return sum;
}

void expectWhole(const Scene& scene) {
  const MeshMotion motion(scene);
  for (const std::string& warning : motionWarnings(scene, motion))
    EXPECT_NE(warning.find(" mL "), std::string::npos) << warning;  // volumes may pass keyframes'

  const std::span<const double> phases = motion.control(SurfaceId{0}).weights.phases();
  SurfaceFrame frame;
  const auto areasAt = [&](double phase) {
    motion.frameAt(phase, frame);
    std::vector<std::vector<Vec3d>> areas;
    for (const SurfaceTopology& surface : motion.surfaces())
      areas.push_back(doubleAreas(surface, frame.positions_m[index(surface.id)]));
    return areas;
  };
  std::vector<std::vector<std::vector<Vec3d>>> at_keyframes;
  for (const double phase : phases) at_keyframes.push_back(areasAt(phase));

  double smallest = 1;  // share of a leaflet's area
  for (int i = 0; i < kFrames; ++i) {
    const double phase = static_cast<double>(i) / kFrames;
    const auto now = areasAt(phase);
    const auto above = std::upper_bound(phases.begin(), phases.end(), phase);
    const auto left = static_cast<std::size_t>(above - phases.begin()) - 1;
    const std::size_t right = (left + 1) % phases.size();
    const double end = right == 0 ? 1 : phases[right];
    const double fraction = (phase - phases[left]) / (end - phases[left]);
    for (std::size_t s = 0; s < now.size(); ++s) {
      const SurfaceTopology& surface = motion.surfaces()[s];
      if (surface.still) continue;
      const auto &before = at_keyframes[left][s], &after = at_keyframes[right][s];
      const std::string where = scene.structures[s].name + " at phase " + std::to_string(phase);
      if (surface.membrane) {
        // A leaflet has no side that could be wrong, but it must not shrink as it swings.
        const double share = sizeOf(now[s]) / std::min(sizeOf(before), sizeOf(after));
        ASSERT_GT(share, kLeastLeaflet) << where;
        smallest = std::min(smallest, share);
        continue;
      }
      ASSERT_EQ(inverted(now[s], before, after, fraction), 0) << where;
      ASSERT_GT(enclosedVolume(surface, frame.positions_m[s]), 0.05e-6) << where;
    }
  }
  std::printf("leaflets keep %.3f of their area\n", smallest);
}

void expectWhole(const heart::Parameters& parameters, int keyframes) {
  const TempFolder folder;
  writeHeart({.parameters = parameters, .keyframes = keyframes}, folder / "heart");
  expectWhole(sceneFrom(folder / "heart/scene.toml"));
}

TEST(HeartMotionWhole, NoTriangleOfTheDefaultHeartInverts) {
  expectWhole(
      sceneFrom(std::filesystem::path(support::kSourceDir) / "examples/beating_heart/scene.toml"));
}

TEST(HeartMotionWhole, NorOfAnInfarctedOne) {
  heart::Parameters parameters = heart::parametersFrom({{"ef", 0.40}});
  for (const int number : {7, 8, 13, 14})
    parameters.segments[static_cast<std::size_t>(number - 1)].amplitude = 0;
  expectWhole(parameters, 12);
}

TEST(HeartMotionWhole, NorOfADilatedOne) {
  expectWhole(heart::parametersFrom({{"edv", 250}, {"ef", 0.25}}), 12);
}

}  // namespace
}  // namespace echocine
