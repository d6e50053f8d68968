// The page that shows the whole program: scene -> motion -> geometry -> trace -> signal -> output.

#include "cine.h"

#include <fmt/format.h>

#include <chrono>

#include "core/error.h"
#include "core/parallel.h"
#include "frame_maker.h"
#include "motion/cardiac_clock.h"
#include "output/output_folder.h"
#include "plan_loop.h"
#include "reference_pass.h"
#include "render_pass.h"

namespace echocine {

namespace {

std::pair<int, int> frameRange(const RenderOptions& options, int loop_frames) {
  const std::pair<int, int> range = options.frames.value_or(std::pair(0, loop_frames));
  if (range.first < 0 || range.first >= range.second || range.second > loop_frames)
    throw SceneError(
        fmt::format("--frames: {}:{} is not in the loop, accepted: A:B with 0 <= A < B <= {}",
                    range.first, range.second, loop_frames));
  return range;
}

}  // namespace

RenderSummary renderCine(const Scene& scene, const RenderOptions& options, const Monitor& monitor) {
  const auto start = std::chrono::steady_clock::now();
  const HeartMotion motion(scene);                // keyframes read, checked, ready to interpolate
  const CardiacClock clock(scene.acquisition);    // when each frame is, and where in the beat
  const LoopPlan plan = planLoop(scene, motion);  // what has to be computed at all, and how
  const auto [first, last] = frameRange(options, clock.frameCount());
  const OutputFolder folder(options.folder, scene.output, options.resume);
  FrameMaker maker(scene, plan, motion);  // motion -> geometry -> trace -> signal of one frame

  RenderSummary summary{.frames_done = 0, .frames_wanted = last - first, .manifest = {}};
  summary.manifest.plan = plan;
  summary.manifest.loop_frames = clock.frameCount();
  summary.manifest.scene_sha256 = sceneSha256(scene, motion);
  withThreads(options.threads, [&] {
    KeptFrames kept;  // the loop's one reference for log compression, then every frame with it
    const auto reference = findReference(scene, plan, maker, clock, monitor, kept);
    if (!reference) return;
    summary.manifest.reference_intensity = *reference;
    RenderPass pass({scene, maker, clock, folder, monitor, options.resume}, summary.manifest, kept);
    summary.frames_done = pass.run(first, last);
    summary.manifest.keyframes = maker.keyframeVolumes();
  });
  if (summary.frames_done < summary.frames_wanted) return summary;

  summary.manifest.stage_ms = maker.clock().milliseconds();
  for (double& ms : summary.manifest.stage_ms) ms /= summary.frames_done;
  const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
  summary.manifest.wall_ms = wall.count() / summary.frames_done;
  summary.manifest.work = maker.work();
  writeManifest(folder.manifest(), scene, summary.manifest);
  return summary;
}

}  // namespace echocine
