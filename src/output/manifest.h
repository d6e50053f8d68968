#pragma once
// manifest.json: input, settings and files of a finished run.

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "core/stage.h"
#include "core/work_counts.h"
#include "motion/surfaces/volumes.h"
#include "output/accuracy_record.h"
#include "output/frame_record.h"
#include "plan/loop_plan.h"

namespace echocine {

struct FrameEntry {
  FrameRecord record;
  Volumes volumes_ml;
  std::string exr_sha256;  // empty without an intensity stack
};

struct Manifest {
  std::string scene_sha256;
  LoopPlan plan;
  AccuracyRecord accuracy;
  double reference_intensity = 1;  // white, relative to I_S
  int loop_frames = 0;
  std::vector<FrameEntry> frames;
  std::vector<KeyframeVolume> keyframes;
  std::array<double, kStages> stage_ms{};  // per frame, summed over threads
  double wall_ms = 0;                      // per frame
  WorkCounts work;                         // of the whole run
  // Curves of the heart's function from truth, a value per frame; names have units.
  std::vector<std::pair<std::string, std::vector<double>>> curves;
  std::vector<std::string> warnings;         // from scene, motion and plan
  std::map<std::string, std::string> files;  // path relative to the folder -> SHA-256
};

// Estimated share of an effect in the time of a frame: the time of a stage is divided among its
// effects in proportion to their counted work. Stages without effects (motion, encoding) are not
// attributed.
double timeShare(const EffectDecision& effect, const Manifest& manifest);

// Parts of the manifest that are also printed separately.
nlohmann::ordered_json effectsJson(const Manifest& manifest);  // name, on, reason, time_share
nlohmann::ordered_json planJson(const LoopPlan& plan);         // tracer, echoes, omissions
nlohmann::ordered_json stageTimesJson(const Manifest& manifest);
nlohmann::ordered_json workJson(const WorkCounts& work);

// Throws JobError.
void writeManifest(const std::filesystem::path& path, const Scene& scene, const Manifest& manifest);

}  // namespace echocine
