#pragma once
// From a file to a loop with its sector, scale and rate.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "echo/echo_loop.h"

namespace echocine::echo {

// What a user may know better than the files. Frames count from 0.
struct SideOptions {
  std::optional<double> fps, mm_per_pixel, pixel_aspect, heart_rate_bpm;  // aspect: height / width
  std::optional<std::string> sector;
  std::optional<double> ed_frame, es_frame;  // may lie between two
  std::vector<double> r_waves_s;             // from the first frame
  bool read_ecg = true;                      // of the picture, where no R wave is known otherwise
};

// A loop with its sector, scale and rate, from a render folder or any video.
EchoLoop readLoop(const std::filesystem::path& path, const SideOptions& side, bool is_real);

}  // namespace echocine::echo
