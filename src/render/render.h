#pragma once
// The whole program in one call: a scene in, a folder with its cine loop out.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "core/monitor.h"
#include "output/manifest.h"

namespace echocine {

struct RenderOptions {
  std::filesystem::path folder;
  int threads = 0;                            // 0: one per core
  std::optional<std::pair<int, int>> frames;  // first and one past the last; none: the whole loop
  bool resume = false;                        // keep frames whose EXR is complete
  bool overwrite = false;                     // also files of another scene in the folder
  AccuracyRecord accuracy{};                  // selection of the scene's accuracy, for the manifest
};

struct RenderSummary {
  int frames_done = 0, frames_wanted = 0;  // fewer if keep_going() became false
  double setup_s = 0;                      // reading and planning
  double frames_s = 0;          // measuring and rendering: grows with the number of frames
  double page_s = 0;            // waiting for the report's page after the frames
  double kept_frame_bytes = 0;  // of a frame kept from the measurement; 0: none is
  Manifest manifest;            // written to the folder if the run was complete
};

// Throws SceneError for unusable scene, meshes or range (nothing is written), and JobError. Frames
// finished before an error or a stop are complete, and the cine of a stopped run is playable.
RenderSummary renderLoop(const Scene& scene, const RenderOptions& options, const Monitor& monitor);

}  // namespace echocine
