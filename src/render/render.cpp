// The page that shows a run: scene -> motion -> plan -> frames into a folder -> manifest. The
// stages of one frame are in frame/simulator.cpp.

#include "render/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "core/error.h"
#include "core/parallel.h"
#include "core/shown_path.h"
#include "core/stage_clock.h"
#include "core/stop.h"
#include "core/together.h"
#include "frame/simulator.h"
#include "frame/structure_volumes.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/probe_placement.h"
#include "output/earlier_hashes.h"
#include "output/exr_stack.h"
#include "output/output_folder.h"
#include "plan/loop_plan.h"
#include "render/render_pass.h"
#include "render/report.h"
#include "signal/signal_chain.h"
#include "trace/trace_frame.h"
#include "video/dicom_writer.h"

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

[[noreturn]] void failOfOtherLoop(const RenderOptions& options) {
  throw SceneError(
      fmt::format("{}: holds the loop of another scene or program version: choose another folder, "
                  "or {}",
                  options.folder.string(),
                  options.resume ? "leave out --resume and give --overwrite" : "give --overwrite"));
}

// Before anything is touched: what is there must be of this scene.
void refuseOtherScene(const Scene& scene, const RenderOptions& options, const Manifest& manifest) {
  if (options.overwrite && !options.resume) return;
  const ExrStack stack(options.folder / "intensity", scene, manifest.scene_sha256, 1);
  for (int i = 0; i < manifest.loop_frames; ++i) {
    if (options.resume)
      stack.refuseOtherScene(i);
    else if (stack.isOfAnotherScene(i))
      failOfOtherLoop(options);
  }
  if (isOfAnotherScene(options.folder / "manifest.json", manifest.scene_sha256))
    failOfOtherLoop(options);
}

// The terminal has whole paths, the manifest and its page none.
void warn(const std::vector<std::string>& warnings, const Scene& scene, const Monitor& monitor,
          Manifest& manifest) {
  for (const std::string& warning : warnings) {
    manifest.warnings.push_back(withoutFolders(warning, scene.file.parent_path()));
    monitor.warn(warning);
  }
}

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Stage times per frame: frames of both passes share the stages up to the signal chain.
void noteCosts(const Simulator& simulator, RenderSummary& summary) {
  Manifest& manifest = summary.manifest;
  manifest.stage_ms = simulator.clock().milliseconds();
  for (std::size_t s = 0; s < kStages; ++s)
    manifest.stage_ms[s] /= static_cast<Stage>(s) <= Stage::signal
                                ? std::max(simulator.tracedFrames(), summary.frames_done)
                                : summary.frames_done;
  manifest.work = simulator.work();
  manifest.keyframes = keyframeVolumes(simulator.scene(), simulator.motion());
}

// Size of a frame that is kept from the measurement of white (loop/kept_frames.h), by its planes; 0
// if the loop keeps none.
double keptFrameBytes(const Simulator& simulator) {
  const EffectPlan& effects = simulator.plan().effects;
  if (effects.rolling) return 0;
  const Scene& scene = simulator.scene();
  const PlaneRequest request = planeRequest(scene, effects);
  const std::size_t planes = request.channels.size() + (request.intensities ? 1 : 0) +
                             (simulator.chain().addsFields() ? 3 : 0);
  return static_cast<double>(planes * sizeof(float)) * scene.probe.lines * scene.probe.samples;
}

}  // namespace

RenderSummary renderLoop(const Scene& given, const RenderOptions& options, const Monitor& monitor) {
  const auto start = std::chrono::steady_clock::now();
  Scene scene;
  std::shared_ptr<const MeshMotion> motion;  // keyframes, ready to interpolate
  RenderSummary summary;
  withThreads(options.threads, [&] {
    scene = placed(given);
    warn(scene.warnings, scene, monitor, summary.manifest);
    motion = std::make_shared<const MeshMotion>(scene);
  });
  const std::pair range = frameRange(options, CardiacClock(scene).frameCount());
  summary.frames_wanted = range.second - range.first;
  Manifest& manifest = summary.manifest;
  manifest.accuracy = options.accuracy;
  manifest.loop_frames = CardiacClock(scene).frameCount();
  manifest.scene_sha256 = sceneSha256(scene, *motion);
  refuseLargeDicom(scene.output, summary.frames_wanted);
  refuseOtherScene(scene, options, manifest);
  std::map<std::string, std::string> earlier;
  if (options.resume)
    earlier = earlierHashes(options.folder / "manifest.json", manifest.scene_sha256);
  withThreads(options.threads, [&] {
    // Decides which effects are computed, and how; then motion -> geometry -> trace -> signal of a
    // frame.
    const Simulator simulator(scene, motion);
    manifest.plan = simulator.plan();
    warn(manifest.plan.warnings, scene, monitor, manifest);
    if (!monitor.keep_going()) return;
    simulator.truth();  // rejects impossible requests before anything is written
    const OutputFolder folder(options.folder, scene.output, options.resume);
    folder.removeStale(manifest.loop_frames);
    summary.setup_s = secondsSince(start);
    ReportPage report(folder.report(), scene, simulator.cardiacClock(), range);
    FolderSink sink({simulator, folder, monitor, report, range, options.resume, earlier}, manifest);
    auto frames_end = std::chrono::steady_clock::now();
    try {
      together(
          [&] {
            summary.frames_done = renderFrames(simulator, range, sink, monitor);
            frames_end = std::chrono::steady_clock::now();
          },
          [&] { report.prepareView(simulator); });
    } catch (...) {
      sink.endEarly();
      throw;
    }
    summary.page_s = secondsSince(frames_end);
    if (summary.frames_done == summary.frames_wanted)
      sink.finish(true);
    else
      unstoppable([&] { sink.finish(false); });  // what is finished stays playable
    summary.frames_s = secondsSince(start) - summary.setup_s - summary.page_s;
    summary.kept_frame_bytes = keptFrameBytes(simulator);
    // No manifest: a folder without one is an unfinished run.
    if (summary.frames_done < summary.frames_wanted) return;
    noteCosts(simulator, summary);
    manifest.wall_ms = 1e3 * secondsSince(start) / summary.frames_done;
    folder.checkStillThere();
    report.finish(manifest, simulator);
    writeManifest(folder.manifest(), scene, manifest);
  });
  return summary;
}

}  // namespace echocine
