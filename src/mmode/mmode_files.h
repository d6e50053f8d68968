#pragma once
// The files of an M-mode.

#include <filesystem>

#include "core/monitor.h"
#include "mmode/mmode.h"

namespace echocine {

struct MModeOptions {
  MModeRequest request;
  std::filesystem::path folder;
  int rows = 480;   // of the picture's echoes, 16 to 8192
  int threads = 0;  // 0: one per core
};

// Makes the M-mode of a scene and writes into the folder:
//   mmode.exr    width: columns, height: samples; channels intensity and display
//   mmode.png    the picture
//   borders.csv  time_s, phase, structure, depth_mm: every crossing of the line and a border
//   ring.csv     time_s, exact_mm, traced_mm (empty after systole): with a ring as target
//   mmode.json   line, rate, white, scene, measurements; written last, with a digest of itself
// Throws SceneError, JobError. Once the line has been found, an earlier mmode.json and ring.csv are
// removed, so a folder with mmode.json is complete.
MMode writeMMode(const Scene& scene, const MModeOptions& options, const Monitor& monitor = {});

}  // namespace echocine
