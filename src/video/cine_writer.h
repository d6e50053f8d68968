#pragma once
// The cine loop: encoded frames in, an AVI file out, written beside and renamed.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "signal/picture.h"

namespace echocine {

// A frame rate as the fraction that files want: 50 -> 50/1, 29.97 -> 30000/1001. Denominator at
// most 1001. Precondition: 0 < frame_rate_hz <= 1e6.
struct Rational {
  int numerator = 0, denominator = 1;
};
Rational rationalFrameRate(double frame_rate_hz);

// One frame compressed on its own (every frame is a key frame). Thread-safe. Throws JobError.
std::vector<std::byte> encodeCineFrame(const GreyImage& image, CineCodec codec, int jpeg_quality);

// The image as PNG. Thread-safe. Throws JobError.
std::vector<std::byte> encodePng(const GreyImage& image);

// The same with pixels that are numbers of a palette, which has an entry for each of them.
struct PaletteColour {
  std::uint8_t red = 0, green = 0, blue = 0;
};
std::vector<std::byte> encodePng(const GreyImage& image, std::span<const PaletteColour> palette);

// Muxes encoded frames into `path`. Until finish() the data stand in a part beside it; a writer
// destroyed without finish() removes them. The frames are of settings.codec, width and height.
class CineWriter {
 public:
  CineWriter(std::filesystem::path path, const OutputSettings& settings, double frame_rate_hz);
  ~CineWriter();

  // Frames in order. Throws JobError (disk full, ...), after which the writer can only be
  // destroyed.
  void add(std::span<const std::byte> encoded_frame);
  void finish();  // throws JobError; without a single frame nothing is left behind

  // finish() for a run that ends early: a longer cine of an earlier run stays in place of this one.
  // After add() has thrown it leaves everything as it is.
  void finishEarly();

 private:
  struct Muxer;
  std::unique_ptr<Muxer> muxer_;
};

}  // namespace echocine
