#include "render/estimate.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core/error.h"
#include "frame/reference_frames.h"
#include "loop/kept_frames.h"
#include "motion/cycle/cardiac_clock.h"
#include "scene/probe_pose.h"
#include "scene/white_rule.h"

namespace echocine {

namespace {

// The plan measures what a render does, files included.
struct TemporaryFolder {
  std::filesystem::path path;

  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "echocine-plan-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw JobError(fmt::format("{}: no temporary folder can be made", name));
    path = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
};

double largestResidentBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

}  // namespace

namespace {

// The first pass of a percentile reference: frames that are kept are traced there instead of later,
// frames that are not are traced twice.
void addFirstPass(const Scene& scene, double traced_share, double frame_s, double kept_frame_bytes,
                  Estimate& estimate) {
  if (scene.signal.reference_intensity || !wantsPicture(scene)) return;
  const double measured = std::min(estimate.frames, kReferenceFrames);
  const double kept =
      kept_frame_bytes > 0
          ? std::min(measured, std::floor(static_cast<double>(kKeptBytes) / kept_frame_bytes))
          : 0;
  estimate.memory_bytes += kept * kept_frame_bytes;
  estimate.seconds += (measured - kept) * traced_share * frame_s;
}

}  // namespace

// Six frames: enough to warm the caches, and a second or two of waiting.
Estimate estimateLoop(const Scene& scene, int threads, const Monitor& monitor) {
  constexpr int kFrames = 6;
  const TemporaryFolder folder;
  Estimate estimate;
  estimate.frames = CardiacClock(scene).frameCount();
  const int rendered = std::min(kFrames, estimate.frames);
  Scene few = scene;  // the reference's value does not change the cost of using it
  few.signal.reference_intensity = scene.signal.reference_intensity.value_or(1);
  const RenderOptions options{
      .folder = folder.path, .threads = threads, .frames = std::pair(0, rendered), .resume = false};
  const RenderSummary summary = renderLoop(few, options, monitor);
  if (summary.frames_done < rendered) throw JobError("stopped while the plan was measured");
  estimate.measured = summary.manifest;
  const double frame_s = summary.frames_s / rendered;
  estimate.seconds = summary.setup_s + frame_s * estimate.frames + summary.page_s;
  estimate.memory_bytes = largestResidentBytes();
  const auto& ms = summary.manifest.stage_ms;
  const double all = std::accumulate(ms.begin(), ms.end(), 0.0);
  const double traced =
      std::accumulate(ms.begin(), ms.begin() + static_cast<int>(Stage::signal) + 1, 0.0);
  addFirstPass(scene, all > 0 ? traced / all : 0, frame_s, summary.kept_frame_bytes, estimate);
  return estimate;
}

nlohmann::ordered_json estimateJson(const Scene& scene, const Estimate& estimate) {
  nlohmann::ordered_json json = planJson(estimate.measured.plan);
  json["probe_toml"] = poseToml(scene);
  json["effects"] = effectsJson(estimate.measured);
  json["white"] = whiteWords(scene);
  json["warnings"] = estimate.measured.warnings;
  json["frames"] = estimate.frames;
  json["seconds"] = estimate.seconds;
  json["memory_bytes"] = estimate.memory_bytes;
  json["timings_ms_per_frame"] = stageTimesJson(estimate.measured);
  return json;
}

}  // namespace echocine
