// The motion stage as a whole on small beating balls.

#include "motion/surfaces/mesh_motion.h"

#include <limits>
#include <numbers>
#include <thread>

#include "tests/stage/motion_fixtures.h"

namespace echocine::motion_test {
namespace {

TEST(MotionHeart, PositionsAreMetresInTheProbeFrame) {
  const TestFolder folder;
  const auto file = folder.write("ball.obj", objText(octahedron(2, {1000, 0, 3})));
  Scene scene = sceneOf(structureOf({file}));
  scene.probe.pose = {{10, 0, 0.01}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
  const MeshMotion motion(scene);
  SurfaceFrame frame;
  motion.frameAt(0.4, frame);
  EXPECT_EQ(frame.positions_m[0][0], (Vec3f{0.02f, 0.02f, 0}));  // world (1002, 0, 3) cm
}

TEST(MotionHeart, LeftHandedProbeFrameKeepsFacesLookingOutward) {
  const TestFolder folder;
  Scene scene = beatingBall(folder, {2}, 0);
  scene.probe.pose.y_axis = {0, -1, 0};
  for (const int levels : {0, 1}) {
    scene.motion.subdivision = levels;
    const MeshMotion motion(scene);
    SurfaceFrame frame;
    motion.frameAt(0, frame);
    EXPECT_GT(enclosedVolume(motion.surfaces()[0], frame.positions_m[0]), 0);
  }
}

TEST(MotionHeart, StillStructureIsTheSameAtEveryPhase) {
  const TestFolder folder;
  for (const int levels : {0, 2}) {
    Scene scene = beatingBall(folder, {2}, 1);
    scene.motion.subdivision = levels;
    const MeshMotion motion(scene);
    SurfaceFrame early, late;
    motion.frameAt(0, early);
    motion.frameAt(0.77, late);
    EXPECT_EQ(early.positions_m, late.positions_m);
    EXPECT_EQ(early.positions_m[0].size(), motion.surfaces()[0].vertex_count);
  }
}

TEST(MotionHeart, VolumesAreThoseOfTheFrame) {
  const TestFolder folder;
  for (const std::vector<double>& radii : {std::vector<double>{2}, std::vector<double>{2, 1.8}})
    for (const Normals normals : {Normals::facet, Normals::smooth}) {
      Scene scene = beatingBall(folder, radii, 1);
      scene.motion.subdivision = 1;
      scene.accuracy.normals = normals;
      const MeshMotion motion(scene);
      const SurfaceTopology& surface = motion.surfaces()[0];
      EXPECT_EQ(surface.still, radii.size() == 1);
      SurfaceFrame frame;
      for (const double phase : {0.0, 0.3}) {
        motion.frameAt(phase, frame);
        EXPECT_GT(motion.volumeIn(frame, surface), 0);
        EXPECT_NEAR(motion.volumeIn(frame, surface) / enclosedVolume(surface, frame.positions_m[0]),
                    1, 1e-13);
      }
    }
}

TEST(MotionHeart, FrameIsReusedWithoutAllocation) {
  const TestFolder folder;
  Scene scene = beatingBall(folder, {2, 1.8, 1.5}, 2);
  scene.motion.subdivision = 1;
  const MeshMotion motion(scene);
  SurfaceFrame frame;
  motion.frameAt(0, frame);
  const Vec3f* const storage = frame.positions_m[0].data();
  motion.frameAt(0.2, frame);
  EXPECT_EQ(frame.positions_m[0].data(), storage);
}

TEST(MotionHeart, ThreadsMayAskForFramesAtOnce) {
  const TestFolder folder;
  Scene scene = beatingBall(folder, {2, 1.8, 1.5, 1.9}, 2);
  scene.motion.subdivision = 1;
  const MeshMotion motion(scene);
  std::vector<SurfaceFrame> alone(8), together(8);
  for (std::size_t i = 0; i < 8; ++i) motion.frameAt(static_cast<double>(i) / 8.5, alone[i]);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < 8; ++i)
    threads.emplace_back([&, i] { motion.frameAt(static_cast<double>(i) / 8.5, together[i]); });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(alone[i].positions_m, together[i].positions_m);
}

TEST(MotionHeart, MembraneEnclosesNothing) {
  const TestFolder folder;
  const auto file = folder.write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  Scene scene = sceneOf(structureOf({file}));
  scene.structures[0].membrane = true;
  const MeshMotion motion(scene);
  SurfaceFrame frame;
  motion.frameAt(0, frame);
  EXPECT_TRUE(motion.surfaces()[0].membrane);
  EXPECT_EQ(enclosedVolume(motion.surfaces()[0], frame.positions_m[0]), 0.0);
}

TEST(MotionHeart, DigestFollowsEveryByteRead) {
  const TestFolder folder;
  const Scene scene = beatingBall(folder, {2, 1.8}, 0);
  const std::string before = MeshMotion(scene).inputSha256();
  EXPECT_EQ(before.size(), 64u);
  EXPECT_EQ(before, MeshMotion(scene).inputSha256());
  folder.write("ball_1.obj", "# a remark\n" + objText(sphere(1.8, 0)));
  EXPECT_NE(before, MeshMotion(scene).inputSha256());
}

TEST(MotionHeart, UnusableScenesAreRefusedAtTheirPlace) {
  const TestFolder folder;
  Scene far = beatingBall(folder, {2}, 0);
  far.probe.pose.origin = {0, 0, 50};
  EXPECT_NE(errorOf([&] { MeshMotion{far}; }).find("scene.toml:7: structure.keyframes: ball: "),
            std::string::npos);
  far.probe.pose.origin = {0, 0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_NE(errorOf([&] { MeshMotion{far}; }), "no error");

  Scene fine = beatingBall(folder, {2}, 0);
  fine.motion.subdivision = 15;
  EXPECT_EQ(errorOf([&] { MeshMotion{fine}; }).rfind("scene.toml:4: motion.subdivision: ", 0), 0u);

  Scene uneven = beatingBall(folder, {2, 2, 2}, 0);
  uneven.structures[0].keyframes[1].phase = 1e-4;
  EXPECT_EQ(errorOf([&] { MeshMotion{uneven}; }).rfind("scene.toml:7: structure.keyframes: ", 0),
            0u);
}

}  // namespace
}  // namespace echocine::motion_test
