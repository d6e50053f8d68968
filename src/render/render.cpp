// The page that shows the whole program: scene -> motion -> geometry -> trace -> signal -> output.

#include "render/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "core/error.h"
#include "core/parallel.h"
#include "motion/cycle/cardiac_clock.h"
#include "output/earlier_hashes.h"
#include "output/exr_stack.h"
#include "output/output_folder.h"
#include "render/reference_pass.h"
#include "render/render_pass.h"
#include "render/report.h"
#include "simulate/frame_maker.h"
#include "simulate/plan_loop.h"

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

[[noreturn]] void failOfOtherLoop(const std::filesystem::path& folder) {
  throw SceneError(
      fmt::format("{}: holds the loop of another scene or program version: choose another folder, "
                  "or give --overwrite",
                  folder.string()));
}

// Before anything is touched: what is there must be of this scene.
void refuseOtherScene(const Scene& scene, const RenderOptions& options, const Manifest& manifest) {
  if (options.overwrite && !options.resume) return;
  const ExrStack stack(options.folder / "intensity", scene, manifest.scene_sha256, 1);
  for (int i = 0; i < manifest.loop_frames; ++i) {
    if (options.resume)
      stack.refuseOtherScene(i);
    else if (stack.isOfAnotherScene(i))
      failOfOtherLoop(options.folder);
  }
  if (!options.resume && isOfAnotherScene(options.folder / "manifest.json", manifest.scene_sha256))
    failOfOtherLoop(options.folder);
}

void warn(const std::vector<std::string>& warnings, const Monitor& monitor, Manifest& manifest) {
  for (const std::string& warning : warnings) {
    manifest.warnings.push_back(warning);
    monitor.warn(warning);
  }
}

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Stage times per frame: frames of both passes share the stages up to the signal chain.
void noteCosts(const FrameMaker& maker, RenderSummary& summary) {
  Manifest& manifest = summary.manifest;
  manifest.stage_ms = maker.clock().milliseconds();
  for (std::size_t s = 0; s < kStages; ++s)
    manifest.stage_ms[s] /= static_cast<Stage>(s) <= Stage::signal
                                ? std::max(maker.tracedFrames(), summary.frames_done)
                                : summary.frames_done;
  manifest.work = maker.work();
  manifest.keyframes = maker.keyframeVolumes();
}

}  // namespace

RenderSummary renderLoop(const Scene& scene, const RenderOptions& options, const Monitor& monitor) {
  const auto start = std::chrono::steady_clock::now();
  RenderSummary summary;
  warn(scene.warnings, monitor, summary.manifest);
  const MeshMotion motion(scene);   // keyframes read, checked, ready to interpolate
  const CardiacClock clock(scene);  // when each frame is, and where in the beat
  const std::pair range = frameRange(options, clock.frameCount());
  summary.frames_wanted = range.second - range.first;
  Manifest& manifest = summary.manifest;
  manifest.accuracy = options.accuracy;
  manifest.loop_frames = clock.frameCount();
  manifest.scene_sha256 = sceneSha256(scene, motion);
  refuseOtherScene(scene, options, manifest);
  std::map<std::string, std::string> earlier;
  if (options.resume)
    earlier = earlierHashes(options.folder / "manifest.json", manifest.scene_sha256);
  withThreads(options.threads, [&] {
    manifest.plan = planLoop(scene, motion);  // what has to be computed at all, and how
    warn(manifest.plan.warnings, monitor, manifest);
    if (!monitor.keep_going()) return;
    const OutputFolder folder(options.folder, scene.output, options.resume);
    folder.removeStale(clock.frameCount());
    FrameMaker maker(scene, manifest.plan, motion);  // motion -> geometry -> trace -> signal
    summary.setup_s = secondsSince(start);
    KeptFrames kept;  // the loop's one reference for log compression, then every frame with it
    const auto reference = findReference(scene, manifest.plan, maker, clock, range, monitor, kept);
    if (!reference) return;
    manifest.reference_intensity = *reference;
    ReportPage report(folder.report(), scene, clock, range);
    RenderPass pass({scene, maker, clock, folder, monitor, report, options.resume, earlier},
                    manifest, kept);
    summary.frames_done = pass.run(range.first, range.second);
    summary.passes_s = secondsSince(start) - summary.setup_s;
    if (summary.frames_done < summary.frames_wanted) return;
    noteCosts(maker, summary);
    manifest.wall_ms = 1e3 * secondsSince(start) / summary.frames_done;
    folder.checkStillThere();
    report.finish(manifest);
    writeManifest(folder.manifest(), scene, manifest);
  });
  return summary;
}

}  // namespace echocine
