#pragma once
// Builds a grey loop from decoded colour frames, with limits against malicious files.

#include <cstddef>
#include <span>

#include "video/video.h"

namespace echocine {

// Limits of input; our choice. A larger file is rejected before it is decoded.
inline constexpr std::int64_t kMaxFramePixels = std::int64_t{1} << 24;  // 4096 x 4096
inline constexpr std::int64_t kMaxLoopPixels = std::int64_t{1} << 29;   // 680 frames of 1024 x 768
inline constexpr std::int64_t kMaxFrameSide = 8192;  // the widest scanner screen has 3840
inline constexpr std::int64_t kMaxLoopFrames = 4096;
inline constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1} << 29;

// Limit of the CPU time for decoding, s: enough for a loop of the largest size, and more for large
// files. A small file that exceeds it was made to be slow.
inline constexpr double kDecodeSeconds = 8, kDecodeSecondsPerByte = 1 / 4e6;

// Throws SceneError for a loop of a size beyond the limits, or without pixels.
void checkLoopSize(const std::string& name, std::int64_t width, std::int64_t height,
                   std::int64_t frames);

class VideoBuilder {
 public:
  explicit VideoBuilder(std::string name);

  // Size of the file, which determines the time limit of decoding.
  void expectBytes(std::size_t bytes);

  // Throws SceneError once this thread has exceeded the time limit of the loop.
  void checkTime() const;

  // A frame of 3 bytes (red, green, blue) per pixel, rows `stride` bytes apart. Throws SceneError
  // for another size than earlier frames, or beyond the limits.
  void add(const std::uint8_t* rgb, int width, int height, std::ptrdiff_t stride);

  Video& video() { return video_; }

  // Finds repeated frames. Throws SceneError for fewer than two frames.
  Video finish();

 private:
  void learnTint(const std::uint8_t* rgb, std::ptrdiff_t stride);

  Video video_;
  double from_s_, allowed_s_;  // CPU time of this thread
  // Colour of a tinted grey scale: red - luma and blue - luma by luma / 16.
  int tint_red_[17] = {}, tint_blue_[17] = {};
};

// Notes frames that are not evenly spaced, by their longest and their mean step, in one unit.
void noteUnevenFrames(double longest, double mean, Video& video);

// Frames whose mean difference from the previous one is below 5 % of the loop's typical difference.
std::vector<int> findRepeats(const std::vector<PixelPlane>& frames);

// Luma of Rec. 601 in 8-bit weights that sum to 256: equal red, green and blue are unchanged.
constexpr int lumaOf(int red, int green, int blue) {
  return (77 * red + 150 * green + 29 * blue + 128) >> 8;
}

}  // namespace echocine
