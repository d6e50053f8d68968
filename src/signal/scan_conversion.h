#pragma once
// From beam space to a picture, by a table that is computed once per loop.

#include <cstdint>
#include <span>
#include <vector>

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
  struct Pixel {
    std::uint32_t pixel;   // in the picture
    std::uint32_t sample;  // in the plane: the shallower sample of the left line
    float across, along;   // weights of the next line and of the next sample
  };
  float valueAt(std::span<const float> grey, const Pixel& p) const;
  void addPixel(const Probe& probe, int pixel, double x_m, double z_m);

  int width_, height_;
  std::size_t next_line_, next_sample_;  // steps in the plane; 0 when there is only one
  std::vector<Pixel> table_;
  std::vector<std::uint8_t> grey_map_;
};

}  // namespace echocine
