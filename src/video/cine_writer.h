#pragma once
// The cine loop: encoded frames in, an AVI file out, written under a temporary name and renamed.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "signal/picture.h"

namespace echocine {

// A frame rate as a fraction for file headers: 50 -> 50/1, 29.97 -> 30000/1001. Denominator at most
// 1001. Precondition: 0 < frame_rate_hz <= 1e6.
struct Rational {
  int numerator = 0, denominator = 1;
};
Rational rationalFrameRate(double frame_rate_hz);

// Compresses one frame independently (every frame is a key frame). Thread-safe. Throws JobError.
std::vector<std::byte> encodeCineFrame(const GreyImage& image, CineCodec codec, int jpeg_quality);

// The image as PNG. Thread-safe. Throws JobError.
std::vector<std::byte> encodePng(const GreyImage& image);

// A PNG whose pixels are indices into a palette. Precondition: the palette has an entry for each.
struct PaletteColour {
  std::uint8_t red = 0, green = 0, blue = 0;
};
std::vector<std::byte> encodePng(const GreyImage& image, std::span<const PaletteColour> palette);

// Muxes encoded frames into `path`. Until finish() the data are in a temporary file; a writer
// destroyed without finish() removes it. The frames have settings.codec, width and height.
class CineWriter {
 public:
  CineWriter(std::filesystem::path path, const OutputSettings& settings, double frame_rate_hz);
  ~CineWriter();

  // Frames in order. Throws JobError (disk full, ...); the writer can then only be destroyed.
  void add(std::span<const std::byte> encoded_frame);
  void finish();  // throws JobError; without frames no file is left

  // finish() for an interrupted run: a longer cine of an earlier run is kept instead. After add()
  // has thrown it changes nothing.
  void finishEarly();

 private:
  struct Muxer;
  std::unique_ptr<Muxer> muxer_;
};

}  // namespace echocine
