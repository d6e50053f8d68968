#pragma once
// Reads a loop with its sector, scale and rate.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "echo/echo_loop.h"

namespace echocine::echo {

// Values given by the user, which override those of the files. Frames count from 0.
struct SideOptions {
  std::optional<double> fps, mm_per_pixel, pixel_aspect, heart_rate_bpm;  // aspect: height / width
  std::optional<std::string> sector;
  std::optional<std::string> label;          // name of the loop in pages and JSON
  std::optional<double> ed_frame, es_frame;  // possibly fractional
  std::vector<double> r_waves_s;             // from the first frame
  bool read_ecg = true;                      // of the picture, if no R wave is known otherwise
};

// Ranges of the numbers, ends included.
inline constexpr double kLeastScale_mm = 1e-3, kMostScale_mm = 100;  // per pixel
inline constexpr double kLeastAspect = 0.2, kMostAspect = 5;
inline constexpr double kLeastHeartRate_bpm = 10, kMostHeartRate_bpm = 400;
inline constexpr double kMostFrame = 1e6, kMostRWave_s = 3600;

// Throws SceneError naming the member for a number out of range or NaN.
void checkSide(const SideOptions& side);

// For a loop made in memory: throws SceneError if its scale is out of range.
void checkScale(const EchoLoop& loop);

// A loop with its sector, scale and rate, from a render folder or any video.
EchoLoop readLoop(const std::filesystem::path& path, const SideOptions& side, bool is_real);

}  // namespace echocine::echo
