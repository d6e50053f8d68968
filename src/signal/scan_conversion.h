#pragma once
// Conversion from beam space to a picture, by a table that is computed once per loop.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/lanes.h"
#include "scene/grey_curve.h"
#include "scene/scene.h"
#include "signal/picture.h"

namespace echocine {

class ScanConverter {
 public:
  // grey_curve: the last step, pixel = 255 g, also as a table. averaged: values along a pixel's
  // side.
  ScanConverter(const Probe& probe, const PictureGeometry& geometry, int width, int height,
                const GreyCurve& grey_curve, int averaged = 1);

  // Bilinear between lines and samples of a line-major grey plane (0..1). Pixels whose centre is
  // outside the scan area stay exactly 0. A pixel larger than the plane's resolution (averagedOver)
  // is the mean of such values over its part of the scan area.
  void convert(std::span<const float> grey, GreyImage& image) const;

  // The same before the grey map and the 8-bit rounding; pixels outside the scan area are -1.
  void convert(std::span<const float> grey, std::vector<float>& picture) const;

  // Values along a pixel's side; 1: the centre only. A pixel no longer than an echo (the pulse or
  // one sample) needs one value. A longer one would pick one value of several, which makes thin
  // walls jagged and valves dashed. Values are no farther apart than the samples, up to
  // kMostAveraged.
  static int averagedOver(const Scene& scene, const PictureGeometry& geometry);
  static constexpr int kMostAveraged = 16;

 private:
  // For eight pixels: the index of the shallower sample of the left line, and in units of 1/65535
  // the weight of the next line in the upper 16 bits and of the next sample in the lower. One cache
  // line.
  struct alignas(64) Block {
    std::uint32_t sample[kFloatLanes], weights[kFloatLanes];
  };
  // Adjacent pixels in a row of a strip, and their first block in the table.
  struct Run {
    std::size_t pixel, count, block;
  };
  // Row y of the strip, with columns begin to end - 1.
  void addRow(const Probe& probe, const PictureGeometry& geometry, int begin, int end, int y);
  void setEntry(const Probe& probe, double line, double path_m, Block& block, int lane) const;
  void averageFine(std::span<const float> grey, std::vector<float>& picture) const;
  void mapGreys(std::span<const float> picture, GreyImage& image) const;
  template <typename Put>
  void forRuns(std::span<const float> grey, const Put& put) const;

  int width_, height_;
  std::size_t next_line_;  // step in the plane; 0 for a single line
  bool single_sample_;     // per line
  bool full_turn_;
  std::vector<Run> runs_;
  std::vector<Block> blocks_;  // the last one of a run is padded with zeros
  std::vector<std::uint8_t> grey_map_;
  int averaged_;
  std::unique_ptr<const ScanConverter> fine_;  // a picture with averaged_ pixels for each; or none
};

}  // namespace echocine
