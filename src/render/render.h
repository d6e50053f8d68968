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
  std::optional<std::pair<int, int>> frames;  // first and one past the last; absent: the whole loop
  bool resume = false;                        // keep frames whose EXR is whole
  bool overwrite = false;                     // also what another scene left in the folder
  AccuracyRecord accuracy{};                  // how the scene's was chosen, for the manifest
};

struct RenderSummary {
  int frames_done = 0, frames_wanted = 0;  // fewer when keep_going() said no
  double setup_s = 0, passes_s = 0;        // reading and planning; measuring and rendering
  Manifest manifest;                       // written to the folder when nothing was cut short
};

// Throws SceneError (scene, meshes or range cannot be used; nothing is written) and JobError.
// Frames that were finished before an error or a stop are whole, and the cine of a stopped run
// plays.
RenderSummary renderLoop(const Scene& scene, const RenderOptions& options, const Monitor& monitor);

}  // namespace echocine
