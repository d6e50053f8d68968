#pragma once
// Loops for slides and web pages: MP4, GIF and animated WebP.

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "signal/picture.h"
#include "video/cine_writer.h"

namespace echocine {

enum class AnimationFormat { mp4, gif, webp };

// By the extension, in any case: .mp4, .gif, .webp.
std::optional<AnimationFormat> animationFormatOf(const std::filesystem::path& path);

// The colour of each grey level.
using GreyColours = std::array<PaletteColour, 256>;

struct AnimationSettings {
  AnimationFormat format = AnimationFormat::mp4;
  int width = 0, height = 0;  // even for MP4
  double frame_rate_hz = 0;
  GreyColours colours{};
};

// Encodes frames into the bytes of a file. GIF and WebP repeat without end. GIF stores the colours
// exactly and times in 1/100 s; WebP and MP4 are lossy. MP4 is H.264 where libavcodec has libx264,
// and MPEG-4 part 2 otherwise. One version of the libraries gives the same bytes in every run.
class AnimationEncoder {
 public:
  explicit AnimationEncoder(const AnimationSettings& settings);  // throws JobError, as the others
  ~AnimationEncoder();

  // Frames in order. Precondition: the image has the size of the settings.
  void add(const GreyImage& image);
  std::vector<std::byte> finish();  // precondition: at least one frame

  std::string_view codec() const;  // "H.264", "MPEG-4 part 2", "GIF", "WebP"

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace echocine
