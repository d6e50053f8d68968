#pragma once
// Recordings in beam space: EchoXFlow (a zarr folder) and zea (an HDF5 file), as loops.

#include <filesystem>
#include <string>
#include <vector>

#include "echo/echo_loop.h"

namespace echocine::echo {

// Side of a pixel of the picture that the recording is converted to. Half of the finest detail that
// fits use; our choice.
inline constexpr double kRecordingPixel_m = 0.3e-3;

// Limits of a recording; our choice.
inline constexpr std::size_t kMostRecordingValues = std::size_t{1} << 27;  // 512 MB as floats
inline constexpr std::size_t kMostEcgSamples = std::size_t{1} << 22;
inline constexpr double kMostRecordingDepth_m = 0.5, kMostRecordingAngle_rad = 1.5;

// The content of both layouts. Lines meet in the apex, at even angles, with samples at even depths.
struct BeamRecording {
  std::string name;         // for messages
  const char* format = "";  // "EchoXFlow", "zea"
  std::size_t frames = 0, samples = 0, lines = 0;
  double first_rad = 0, last_rad = 0;          // of the outermost lines, positive to the right
  double first_depth_m = 0, last_depth_m = 0;  // of the centres of the outermost samples
  std::vector<std::vector<float>> greys;       // per frame, line-major, 0 to 255
  std::vector<double> times_s;                 // of the frames; empty: unknown
  std::vector<double> ecg, ecg_s;              // samples and their times, on the frames' clock
  std::vector<std::string> notes;
};

// By its files: a zarr store, a catalogue of such stores, or an HDF5 file.
bool isBeamRecording(const std::filesystem::path& path);

// The loop with its exact sector and scale, grey levels in beam space, frame rate, R waves and
// heart rate of its ECG. Its picture comes from the scan converter (signal/scan_conversion.h).
// Every fault is a SceneError of one line.
EchoLoop readBeamRecording(const std::filesystem::path& path);

// The two layouts.
BeamRecording readEchoXFlow(const std::filesystem::path& store);
BeamRecording readZea(const std::filesystem::path& file);

// Throws SceneError for a geometry or a number of values beyond the limits. Readers call it before
// they take memory for the values.
void checkRecording(const BeamRecording& recording);

// Frame `f` of bytes (frame, sample, line) in the order of TracedGreys.
template <typename T, typename Grey>
std::vector<float> linesFirst(const BeamRecording& r, const std::vector<T>& values, std::size_t f,
                              const Grey& grey) {
  std::vector<float> out(r.samples * r.lines);
  const T* frame = values.data() + f * out.size();
  for (std::size_t k = 0; k < r.samples; ++k)
    for (std::size_t i = 0; i < r.lines; ++i)
      out[i * r.samples + k] = static_cast<float>(grey(frame[k * r.lines + i]));
  return out;
}

}  // namespace echocine::echo
