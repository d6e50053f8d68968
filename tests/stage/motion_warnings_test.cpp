// The words for what breaks between keyframes.

#include "motion/surfaces/motion_warnings.h"

#include <fmt/format.h>

#include "motion/cycle/cardiac_clock.h"
#include "tests/stage/motion_fixtures.h"

namespace echocine::motion_test {
namespace {

// A cake whose top's middle slips towards the middle of its side 0, at 1.85.
Scene slipScene(const TestFolder& folder, const std::vector<double>& slips, Interpolation kind) {
  std::vector<TriangleMesh> keyframes;
  for (const double slip : slips)
    keyframes.push_back(cake(kMiddle + slip * Vec3d{0.92387953, 0.38268343, 0}));
  return sceneWith(folder, keyframes, kind);
}

std::string onlyWarning(const Scene& scene) {
  const std::vector<std::string> warnings = motionWarnings(scene, MeshMotion(scene));
  EXPECT_EQ(warnings.size(), 1u);
  return warnings.empty() ? "" : warnings.front();
}

TEST(MotionWarnings, WholeMotionIsSilent) {
  const TestFolder folder;
  const Scene scene = beatingBall(folder, {2, 1.6, 1.5, 1.8}, 2);
  EXPECT_TRUE(motionWarnings(scene, MeshMotion(scene)).empty());
}

TEST(MotionWarnings, MirroredTriangleIsNamedWithStructureFrameFaceAndFiles) {
  const TestFolder folder;
  Scene scene = slipScene(folder, {0, 0, 2.2, 2.2}, Interpolation::linear);
  scene.acquisition = {.heart_rate_hz = 1, .frame_rate_hz = 25, .beats = 1};
  // 2.2 (4 t - 1) passes 1.85 at t = 0.46; back again it stays beyond up to 0.79.
  EXPECT_EQ(
      onlyWarning(scene),
      "scene.toml:7: structure.keyframes: ball: frame 12: " + folder.path("ball_1.obj").string() +
          ": face 1 turns over between this file and " + folder.path("ball_2.obj").string() +
          "; it is folded in one of the two: correct one of the two files");
}

// The frames are those of the loop, whose clock may warp the keyframes' beat.
TEST(MotionWarnings, FramesAreThoseOfAWarpedBeat) {
  const TestFolder folder;
  Scene scene = slipScene(folder, {0, 0, 2.2, 2.2}, Interpolation::linear);
  scene.acquisition = {.heart_rate_hz = 2, .frame_rate_hz = 50, .beats = 1};
  scene.motion.keyframe_heart_rate_hz = 1;
  const CardiacClock clock(scene);
  int first = 0;
  while (clock.at(first).phase < 0.25 * (1 + 1.8477590650225735 / 2.2)) ++first;
  EXPECT_GT(first, 13);  // 12 without a warp
  const std::string named = fmt::format("frame {}: ", first), warning = onlyWarning(scene);
  EXPECT_NE(warning.find(named), std::string::npos) << named << warning;
}

TEST(MotionWarnings, FurtherFacesAreCounted) {
  const TestFolder folder;
  const std::string warning = onlyWarning(slipScene(folder, {0, 0, 5, 5}, Interpolation::linear));
  EXPECT_NE(warning.find("; 2 more faces of the structure: "), std::string::npos) << warning;
}

TEST(MotionWarnings, OvershootOffersTheLinearKind) {
  const TestFolder folder;
  Scene scene = slipScene(folder, {0, 0, 1.75, 1.75}, Interpolation::catmull_rom);
  const std::string warning = onlyWarning(scene);
  EXPECT_NE(warning.find(" is inverted between this file and "), std::string::npos) << warning;
  EXPECT_TRUE(
      warning.ends_with(": keyframes closer in time or motion.interpolation = \"linear\" avoid it"))
      << warning;
  scene.motion.interpolation = Interpolation::linear;
  EXPECT_TRUE(motionWarnings(scene, MeshMotion(scene)).empty());
}

TEST(MotionWarnings, CollapseIsNamedWithItsShare) {
  const TestFolder folder;
  TriangleMesh other = sphere(2, 1);
  for (Vec3d& p : other.positions) p = {-p.x, -p.y, p.z};
  Scene scene = sceneWith(folder, {sphere(2, 1), other}, Interpolation::linear);
  scene.acquisition = {.heart_rate_hz = 1, .frame_rate_hz = 10, .beats = 1};
  EXPECT_EQ(onlyWarning(scene),
            "scene.toml:7: structure.keyframes: ball: frame 2: has 4 % of the volume of its "
            "keyframes " +
                folder.path("ball_0.obj").string() + " and " + folder.path("ball_1.obj").string() +
                ": keyframes closer in time are needed");
}

TEST(MotionWarnings, InsideOutIsAFailedJob) {
  const TestFolder folder;
  std::vector<TriangleMesh> keyframes{octahedron(2), octahedron(2), octahedron(0.06),
                                      octahedron(0.06)};
  Scene scene = sceneWith(folder, keyframes, Interpolation::catmull_rom);
  scene.acquisition = {.heart_rate_hz = 1, .frame_rate_hz = 16, .beats = 3};
  try {
    motionWarnings(scene, MeshMotion(scene));
    FAIL() << "accepted";
  } catch (const JobError& error) {
    EXPECT_EQ(std::string(error.what()),
              "scene.toml:7: structure.keyframes: ball: frame 9: encloses " +
                  std::string("-0.002414 mL between ") + folder.path("ball_2.obj").string() +
                  " and " + folder.path("ball_3.obj").string() +
                  ": it is inverted in between, a positive volume is accepted: keyframes closer "
                  "in time or motion.interpolation = \"linear\" avoid it");
  }
}

TEST(MotionWarnings, EachPhaseIsLookedAtOnceAndTheEarliestFrameNamed) {
  const TestFolder folder;
  Scene scene = slipScene(folder, {0, 0, 2.2, 2.2}, Interpolation::linear);
  scene.acquisition = {.heart_rate_hz = 1, .frame_rate_hz = 25, .beats = 1};
  const std::string once = onlyWarning(scene);
  scene.acquisition.beats = 3;
  EXPECT_EQ(onlyWarning(scene), once);
}

}  // namespace
}  // namespace echocine::motion_test
