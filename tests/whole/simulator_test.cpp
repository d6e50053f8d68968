// One frame as a caller gets it: the bytes of a render, from any thread, with or without files.

#include "frame/simulator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "frame/reference_frames.h"
#include "loop/render_frames.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/heart/heart_scene.h"
#include "motion/surfaces/mesh_motion.h"
#include "output/exr_plane.h"
#include "output/exr_stack.h"
#include "output/heart_files.h"
#include "render/render.h"
#include "scene/scene_reader.h"
#include "support/loop_scene.h"
#include "support/scene_text.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace support;

Scene smallHeart() {
  Scene scene;
  withThreads(2, [&] { scene = heart::heartScene({}, heart::View::a4c, 6, Look::paper); });
  scene.probe.lines = 48;
  scene.probe.samples = 96;
  scene.output.width = 96;
  scene.output.height = 72;
  return scene;
}

TEST(SimulatorFrame, OfAHeartInMemoryIsThatOfItsFiles) {
  const TempFolder folder;
  HeartFiles wanted;
  wanted.keyframes = 6;
  wanted.look = Look::paper;
  writeHeart(wanted, folder / "heart");
  Scene written = readScene(folder / "heart" / "scene.toml");
  const Scene in_memory = smallHeart();
  written.probe.lines = in_memory.probe.lines;
  written.probe.samples = in_memory.probe.samples;
  written.output = in_memory.output;
  const Simulator files(written), memory(in_memory);
  for (const double time_s : {0.0, 0.14, 0.6171}) {
    const Frame a = files.frame(time_s), b = memory.frame(time_s);
    EXPECT_EQ(a.intensities, b.intensities) << time_s;
    EXPECT_EQ(a.greys, b.greys) << time_s;
    EXPECT_EQ(a.image.pixels, b.image.pixels) << time_s;
    EXPECT_EQ(a.volumes_ml, b.volumes_ml) << time_s;
  }
}

TEST(SimulatorFrame, HasTheIntensitiesThatARenderWrites) {
  const TempFolder folder;
  Scene scene = smallHeart();
  scene.signal.reference_intensity.reset();  // found over the loop, by both
  scene.output.channels = {Channel::y, Channel::display};
  const RenderSummary summary =
      renderLoop(scene, {.folder = folder / "out", .threads = 2, .frames = {}}, {});
  const Simulator simulator(scene);
  EXPECT_EQ(simulator.referenceIntensity(), summary.manifest.reference_intensity);
  for (const int f : {0, 7, summary.frames_done - 1}) {
    const Frame frame = simulator.frame(f / scene.acquisition.frame_rate_hz);
    EXPECT_EQ(frame.time.frame, f);
    const auto stored = [&](Channel channel) {
      return readExrPlane(folder / "out" / "intensity" / ExrStack::fileName(f),
                          {channel, summary.manifest.scene_sha256, f, 48, 96})
          .value();
    };
    EXPECT_EQ(stored(Channel::y), frame.channels.at(Channel::y));
    EXPECT_EQ(stored(Channel::display), frame.greys.values);
  }
}

// Law: white belongs to the loop, not to who asks for it, also where not every frame is measured.
TEST(SimulatorFrame, OfALongLoopHasTheWhiteOfItsRender) {
  Scene scene = smallHeart();
  scene.acquisition.frame_rate_hz = 160;
  scene.signal.reference_intensity.reset();
  const auto motion = std::make_shared<const MeshMotion>(scene);
#ifdef ECHOCINE_SANITIZED
  const std::vector<double> percentiles{60.0};
#else
  const std::vector<double> percentiles{40.0, 60.0, 80.0, 90.0};
#endif
  for (const double percentile : percentiles) {
    scene.signal.reference_percentile = percentile;
    const Simulator simulator(scene, motion);
    ASSERT_GT(simulator.cardiacClock().frameCount(), 2 * kReferenceFrames);
    struct : FrameSink {
      double white = 0;
      void begin(double measured) override { white = measured; }
      std::shared_ptr<void> take(MadeFrame&) override { return nullptr; }
    } sink;
    withThreads(2, [&] { renderFrames(Simulator(scene, motion), {5, 6}, sink, {}); });
    EXPECT_EQ(simulator.referenceIntensity(), sink.white);
  }
}

// Every part of the loop is met once, and short loops whole.
TEST(ReferenceFrames, LieOneInEachEqualPartOfTheLoop) {
  for (const int count : {0, 1, 63, 64, 65, 100, 127, 128, 1000, 999'999}) {
    const std::vector<int> frames = referenceFrames(count);
    const auto parts = static_cast<std::size_t>(std::min(count, kReferenceFrames));
    ASSERT_EQ(frames.size(), parts) << count;
    for (std::size_t k = 0; k < parts; ++k) {
      const double part = static_cast<double>(count) / static_cast<double>(parts);
      EXPECT_GE(frames[k] + 1, part * static_cast<double>(k)) << count;
      EXPECT_LT(frames[k], part * static_cast<double>(k + 1)) << count;
      if (k > 0) {
        EXPECT_GE(frames[k], frames[k - 1]) << count;
      }
    }
  }
}

TEST(SimulatorFrame, FromTwoThreadsAtOnceIsThatOfOne) {
  const Simulator simulator(smallHeart());
  constexpr int kFrames = 24;
  std::vector<Frame> alone(kFrames), together(kFrames);
  for (int i = 0; i < kFrames; ++i) alone[static_cast<std::size_t>(i)] = simulator.frame(0.03 * i);
  const auto work = [&](int first) {
    for (int i = first; i < kFrames; i += 2)
      simulator.frame(0.03 * i, together[static_cast<std::size_t>(i)]);
  };
  std::thread other(work, 1);
  work(0);
  other.join();
  for (std::size_t i = 0; i < kFrames; ++i) {
    EXPECT_EQ(alone[i].intensities, together[i].intensities) << i;
    EXPECT_EQ(alone[i].image.pixels, together[i].image.pixels) << i;
  }
}

TEST(SimulatorFrame, CarriesTruthWhereTheSceneAsksForIt) {
  Scene scene = smallHeart();
  EXPECT_FALSE(Simulator(scene).frame(0.1).truth);
  scene.truth.labels = scene.truth.contours = true;
  const Simulator simulator(scene);
  const Frame frame = simulator.frame(0.1);
  ASSERT_TRUE(frame.truth);
  EXPECT_EQ(frame.truth->labels.size(), frame.image.pixels.size());
  EXPECT_GT(frame.truth->contours.size(), 5u);
  EXPECT_FALSE(frame.truth->function);
  EXPECT_EQ(simulator.truthAt(frame.time).labels, frame.truth->labels);
}

// A frame's memory may come from a scene with other channels and another size.
TEST(SimulatorFrame, KeepsNoChannelOfAnotherScene) {
  Scene first = smallHeart(), second = smallHeart();
  first.output.channels = {Channel::y, Channel::attenuation};
  second.output.channels = {Channel::reflection};
  second.probe.lines = 64;
  second.probe.samples = 200;
  const Simulator a(first), b(second);
  Frame used;
  a.frame(0.1, used);
  for (const double time_s : {0.1, 0.2, 0.3}) {
    b.frame(time_s, used);
    EXPECT_EQ(used.channels, b.frame(time_s).channels) << time_s;
  }
  EXPECT_EQ(used.channels.size(), 1u);
  a.frame(0.1, used);
  EXPECT_EQ(used.channels, a.frame(0.1).channels);
}

TEST(SimulatorFrame, OutsideTheLoopIsRefusedByItsKeys) {
  const Simulator simulator(smallHeart());
  for (const double time_s : {-0.01, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    try {
      simulator.frame(time_s);
      ADD_FAILURE() << time_s;
    } catch (const SceneError& error) {
      EXPECT_NE(std::string(error.what()).find("acquisition.beats"), std::string::npos);
    }
  }
}

TEST(SimulatorMeshes, InMemoryAreNamedInMessages) {
  NamedMeshes meshes;
  auto open = std::make_shared<TriangleMesh>();
  open->positions = {{0, 0, 0}, {30, 0, 0}, {0, 30, 0}, {0, 0, 30}};
  open->triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}};  // without its fourth side
  meshes["tent"] = open;
  const std::string text = R"(
background = "soft_tissue"
probe = {apex = [0, 0, -20], axis = [0, 0, 1], lateral = [1, 0, 0], sector_deg = 60, depth_mm = 100, frequency_mhz = 2.5}
[[structure]]
name = "tent"
medium = "blood"
keyframes = "tent"
)";
  const Scene scene = parseScene(text, "in memory", meshes);
  try {
    const Simulator simulator(scene);
    ADD_FAILURE();
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("tent: face 1 has an open edge"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(parseScene(text, "in memory", NamedMeshes{}), SceneError);
}

}  // namespace
}  // namespace echocine
