#pragma once
// From beam space to a picture, by a table that is computed once per loop.

#include <cstdint>
#include <span>
#include <vector>

#include "core/lanes.h"
#include "signal/picture.h"

namespace echocine {

class ScanConverter {
 public:
  // grey_gamma: the last step, pixel = 255 (grey)^gamma, as a table too.
  ScanConverter(const Probe& probe, const PictureGeometry& geometry, int width, int height,
                double grey_gamma);

  // Bilinear between lines and samples of a line-major grey plane (0..1); pixels whose centre lies
  // outside the scan area stay exactly 0.
  void convert(std::span<const float> grey, GreyImage& image) const;

  // The same before the grey map and its 8 bits; pixels outside the scan area are -1.
  void convert(std::span<const float> grey, std::vector<float>& picture) const;

 private:
  // Of eight pixels, in the plane the shallower sample of the left line, and in parts of 65535 the
  // weight of the next line in the upper 16 bits and that of the next sample in the lower. One
  // cache line.
  struct alignas(64) Block {
    std::uint32_t sample[kFloatLanes], weights[kFloatLanes];
  };
  // Pixels beside each other in a row of a strip, and their first block in the table.
  struct Run {
    std::size_t pixel, count, block;
  };
  // Row y of the strip with the columns begin to end - 1.
  void addRow(const Probe& probe, const PictureGeometry& geometry, int begin, int end, int y);
  static void setEntry(const Probe& probe, double line, double path_m, Block& block, int lane);
  template <typename Put>
  void forRuns(std::span<const float> grey, const Put& put) const;

  int width_, height_;
  std::size_t next_line_;  // step in the plane; 0 when there is only one line
  bool single_sample_;     // per line
  std::vector<Run> runs_;
  std::vector<Block> blocks_;  // the last one of a run is filled up with zeros
  std::vector<std::uint8_t> grey_map_;
};

}  // namespace echocine
