#pragma once
// From decoded colour frames to a grey loop, within limits that a small file cannot break.

#include <cstddef>
#include <span>

#include "video/video.h"

namespace echocine {

// Limits of what is read; our choice. A file that promises more is refused before it is decoded.
inline constexpr std::int64_t kMaxFramePixels = std::int64_t{1} << 24;  // 4096 x 4096
inline constexpr std::int64_t kMaxLoopPixels = std::int64_t{1} << 29;   // 680 frames of 1024 x 768
inline constexpr std::int64_t kMaxFrameSide = 8192;  // the widest scanner's screen has 3840
inline constexpr std::int64_t kMaxLoopFrames = 4096;
inline constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t{1} << 29;

// CPU time that decoding may take, s: what a loop of the largest size takes, and longer for large
// files. Past it a small file is one made to be slow.
inline constexpr double kDecodeSeconds = 8, kDecodeSecondsPerByte = 1 / 4e6;

// Throws SceneError when a loop of this size is beyond the limits or no picture at all.
void checkLoopSize(const std::string& name, std::int64_t width, std::int64_t height,
                   std::int64_t frames);

class VideoBuilder {
 public:
  explicit VideoBuilder(std::string name);

  // How large the file is, from which its time to decode follows.
  void expectBytes(std::size_t bytes);

  // Throws SceneError once this thread has worked longer on the loop than its file allows.
  void checkTime() const;

  // A frame of 3 bytes (red, green, blue) per pixel, rows `stride` bytes apart.
  // Throws SceneError: another size than the frames before, or beyond the limits.
  void add(const std::uint8_t* rgb, int width, int height, std::ptrdiff_t stride);

  Video& video() { return video_; }

  // Finds repeated frames. Throws SceneError when the loop has fewer than two frames.
  Video finish();

 private:
  void learnTint(const std::uint8_t* rgb, std::ptrdiff_t stride);

  Video video_;
  double from_s_, allowed_s_;  // CPU time of this thread
  // Colour of a grey scale that is shown tinted: red - luma and blue - luma by luma / 16.
  int tint_red_[17] = {}, tint_blue_[17] = {};
};

// Frames whose mean difference from the one before is under 5 % of what is usual in the loop.
std::vector<int> findRepeats(const std::vector<PixelPlane>& frames);

// Luma of Rec. 601 in 8-bit weights that sum to 256: equal red, green and blue stay as they are.
constexpr int lumaOf(int red, int green, int blue) {
  return (77 * red + 150 * green + 29 * blue + 128) >> 8;
}

}  // namespace echocine
