#pragma once
// A loop as read: grey frames, and the information in its file.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace echocine {

using PixelPlane = std::vector<std::uint8_t>;  // rows from the top, one byte a pixel

// A region of a DICOM file (Sequence of Ultrasound Regions, PS3.3 C.8.5.5), pixels, ends included.
struct UltrasoundRegion {
  int min_x = 0, min_y = 0, max_x = 0, max_y = 0;
  double cm_per_pixel_x = 0, cm_per_pixel_y = 0;  // 0: no length scale in the file
};

// Valid frame rates of an acquisition; our choice.
inline constexpr double kLeastFrameRate_hz = 0.5, kMostFrameRate_hz = 10000;

struct FrameRate {
  double hz = 0;
  std::string source;    // "--fps", "DICOM FrameTime", "manifest", "container"
  bool trusted = false;  // a container's rate is that of playback, not of acquisition
};

struct Video {
  std::string name;    // the path as given, for messages
  std::string format;  // "DICOM", "mov,mp4", ...
  int width = 0, height = 0;
  std::vector<PixelPlane> frames;
  PixelPlane coloured;  // 1 if any frame has colour over the grey level; excluded from comparisons
  FrameRate rate;
  std::optional<double> heart_rate_bpm;
  std::string heart_rate_source;  // "--heart-rate", "DICOM HeartRate", "DICOM NominalInterval"
  std::vector<double> r_waves_s;  // from the first frame, by the file's tags; ascending
  // They are frames over rate.hz, by the times of uneven frames; otherwise as measured.
  bool r_waves_by_frames = false;
  std::vector<UltrasoundRegion> regions;
  std::vector<int> repeats;        // frames that repeat the previous one
  std::vector<std::string> notes;  // anomalies found while reading, a line each

  int frameCount() const { return static_cast<int>(frames.size()); }
  bool isRepeat(int frame) const {
    for (const int r : repeats)
      if (r == frame) return true;
    return false;
  }
};

// True if each number is above the one before it.
inline bool areAscending(const std::vector<double>& numbers) {
  return std::adjacent_find(numbers.begin(), numbers.end(), std::greater_equal<>()) ==
         numbers.end();
}

}  // namespace echocine
