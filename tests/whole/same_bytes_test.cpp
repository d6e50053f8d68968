// The same scene gives the same bytes for any number of threads, and the files hold what was in
// memory.

#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <tuple>

#include "frame/simulator.h"
#include "frame/workspace.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/surfaces/mesh_motion.h"
#include "render/render.h"
#include "support/exr_planes.h"
#include "support/loop_scene.h"
#include "support/run_files.h"
#include "trace/trace_frame.h"

namespace echocine {
namespace {

using namespace support;

// The contract: same scene, same bytes, whatever the number of threads.
TEST(SameBytes, OneTwoAndFourThreadsWriteTheSameFiles) {
  const TempFolder folder;
  for (const auto& [name, refraction, rays, slices] :
       {std::tuple{"straight", "\"off\"", "1", "1"}, std::tuple{"bent", "\"on\"", "1", "1"},
        std::tuple{"beams", "\"on\"", "5", "1"}, std::tuple{"slices", "\"off\"", "1", "5"}}) {
    SceneText text = ballScene(6);
    text.effects["refraction"] = refraction;
    text.accuracy["rays_per_beam"] = rays;
    text.accuracy["elevation_slices"] = slices;
    text.output["png"] = "true";
    text.output["dicom"] = "true";
    text.output["channels"] =
        "[\"Y\", \"unattenuated.Y\", \"attenuation.A\", \"reflection.Y\", "
        "\"backscatter.Y\", \"medium.id\", \"display.Y\"]";
    const Scene scene = readScene(writeBall(folder, text));
    std::map<std::string, std::string> one;
    for (const int threads : {1, 2, 4}) {
      const std::filesystem::path out = folder / (name + std::to_string(threads));
      renderLoop(scene, {.folder = out, .threads = threads, .frames = {}}, {});
      const std::map<std::string, std::string> files = lastingFiles(out);
      EXPECT_EQ(files.size(), 16u);
      if (threads == 1) one = files;
      for (const auto& [file, bytes] : one) {
        ASSERT_TRUE(files.contains(file)) << file;
        EXPECT_TRUE(files.at(file) == bytes) << file << " with " << threads << " threads";
      }
    }
  }
}

TEST(SameBytes, AnotherRunWritesTheSameFiles) {
  const TempFolder folder;
  const Scene scene = readScene(writeBall(folder, ballScene(5)));
  renderLoop(scene, {.folder = folder / "a", .threads = 2, .frames = {}}, {});
  renderLoop(scene, {.folder = folder / "b", .threads = 2, .frames = {}}, {});
  EXPECT_EQ(lastingFiles(folder / "a"), lastingFiles(folder / "b"));
}

// Rays are drawn for the number of the frame in its loop, not for the order of the work.
// Its reference is that of the whole loop, so parts can be rendered on many machines.
TEST(SameBytes, APartOfALoopHasTheBeamsOfTheWhole) {
  const TempFolder folder;
  SceneText text = ballScene(5);
  text.accuracy["rays_per_beam"] = "4";
  const Scene scene = readScene(writeBall(folder, text));
  renderLoop(scene, {.folder = folder / "whole", .threads = 2, .frames = {}}, {});
  renderLoop(scene, {.folder = folder / "part", .threads = 1, .frames = std::pair(2, 4)}, {});
  for (const char* frame : {"intensity/frame_0002.exr", "intensity/frame_0003.exr"})
    EXPECT_TRUE(bytesOf(folder / "whole" / frame) == bytesOf(folder / "part" / frame)) << frame;
  text.acquisition["seed"] = "2";
  const Scene other = readScene(writeBall(folder, text));
  renderLoop(other, {.folder = folder / "other", .threads = 1, .frames = std::pair(2, 4)}, {});
  EXPECT_NE(exrPlane(folder / "other/intensity/frame_0002.exr", "Y").bits,
            exrPlane(folder / "part/intensity/frame_0002.exr", "Y").bits);
}

// The stack is compared with a frame that is traced here, bit by bit.
TEST(IntensityStack, HoldsTheFrameThatWasTraced) {
  const TempFolder folder;
  SceneText text = ballScene(3);
  text.effects["refraction"] = "\"on\"";
  text.output["channels"] = "[\"Y\", \"attenuation.A\", \"medium.id\"]";
  const Scene scene = readScene(writeBall(folder, text));
  renderLoop(scene, {.folder = folder / "out", .threads = 2, .frames = {}}, {});

  const Simulator simulator(scene);
  const std::shared_ptr<Workspace> workspace = simulator.workspace();
  simulator.trace(simulator.cardiacClock().at(1), *workspace);
  const PolarFrame& frame = workspace->polar;
  const auto same = [&](const char* channel, const auto& plane) {
    const ExrPlane read = exrPlane(folder / "out/intensity/frame_0001.exr", channel);
    ASSERT_EQ(read.lines, scene.probe.lines);
    ASSERT_EQ(read.samples, scene.probe.samples);
    for (int line = 0; line < read.lines; ++line)
      for (int k = 0; k < read.samples; ++k)
        ASSERT_EQ(
            read.bits[static_cast<std::size_t>(k * read.lines + line)],
            std::bit_cast<std::uint32_t>(plane[static_cast<std::size_t>(line * read.samples + k)]))
            << channel << " line " << line << " sample " << k;
  };
  same("Y", frame.planes.at(Channel::y));
  same("attenuation.A", frame.planes.at(Channel::attenuation));
  same("medium.id", frame.medium);
}

TEST(IntensityStack, ReflectionAndBackscatterMakeYWhateverElseIsAskedFor) {
  const TempFolder folder;
  const auto render = [&](const std::string& name, const std::string& channels) {
    SceneText text = ballScene(1);
    text.output["channels"] = channels;
    renderLoop(readScene(writeBall(folder, text)),
               {.folder = folder / name, .threads = 1, .frames = {}}, {});
    return folder / name / "intensity/frame_0000.exr";
  };
  const auto all = render("all", "[\"Y\", \"reflection.Y\", \"backscatter.Y\"]");
  const auto alone = render("alone", "[\"reflection.Y\"]");
  EXPECT_EQ(exrPlane(all, "reflection.Y").bits, exrPlane(alone, "reflection.Y").bits);
  const ExrPlane whole = exrPlane(all, "Y"), echoes = exrPlane(all, "reflection.Y"),
                 scattered = exrPlane(all, "backscatter.Y");
  for (std::size_t i = 0; i < whole.bits.size(); ++i)
    EXPECT_FLOAT_EQ(std::bit_cast<float>(whole.bits[i]),
                    std::bit_cast<float>(echoes.bits[i]) + std::bit_cast<float>(scattered.bits[i]));
}

}  // namespace
}  // namespace echocine
