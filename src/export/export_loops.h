#pragma once
// Writes loops as one MP4, GIF or WebP file for slides and web pages.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "export/tint.h"

namespace echocine {

// Ranges, ends included; our choice.
inline constexpr std::size_t kMostExportedLoops = 16;
inline constexpr double kLeastSpeed = 0.01, kMostSpeed = 10;
inline constexpr int kMostRepeats = 100;
inline constexpr int kLeastExportWidth = 16, kMostExportWidth = 4096;

// Browsers show GIF frames of less than 1/50 s slowly; screens show 60 frames a second.
inline constexpr double kMostGifRate_hz = 50, kMostScreenRate_hz = 60;

struct ExportOptions {
  std::vector<std::filesystem::path> loops;  // folders of renders, videos, DICOM files
  std::filesystem::path output;              // its extension selects the format
  std::vector<std::string> captions;         // none, or one per loop
  int columns = 0;                           // 0: a nearly square grid
  int width = 0;                             // of each loop, px; 0: of the first one
  int repeats = 1;                           // of the loop in an MP4; GIF and WebP repeat anyway
  double speed = 1;                          // playback, 1: as acquired
  std::optional<double> fps;  // of loops whose files have no frame rate, or overrides
  Tint tint = Tint::none;
  int threads = 0;
};

struct Exported {
  std::string codec;
  int width = 0, height = 0, frames = 0;
  double frame_rate_hz = 0;
  std::vector<std::string> notes;  // what differs from the loops as acquired
};

// Throws SceneError for invalid options, and JobError if the output cannot be written. Reads no
// loop.
void checkExport(const ExportOptions& options);

// Replaces an existing file. Pictures of a finished render are shown whole; other videos show the
// sector only, because text beside it may name a patient. Throws SceneError for invalid options or
// loops, JobError for a failed write.
Exported exportLoops(const ExportOptions& options);

}  // namespace echocine
