#pragma once
// Displayed pictures, and the position of the probe frame in them.

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace echocine {

// An 8-bit grey picture, rows from the top.
struct GreyImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;
};

// Position of the probe frame in the picture: pixel = origin + metres / metres_per_pixel, x to the
// right along the lateral axis, y down along the depth axis.
struct PictureGeometry {
  double origin_x_px = 0, origin_y_px = 0;  // the apex (curvilinear: the centre of curvature)
  double metres_per_pixel = 1;
  int ecg_strip_px = 0;  // rows at the bottom, below the sector
};

// A point of the imaging plane (probe frame, m) in the picture: pixel (i, j) covers i..i+1, j..j+1.
struct PixelPoint {
  double x = 0, y = 0;  // pixels
};
inline PixelPoint pixelOf(const PictureGeometry& g, Vec3d point_m) {
  return {g.origin_x_px + point_m.x / g.metres_per_pixel,
          g.origin_y_px + point_m.z / g.metres_per_pixel};
}

// The largest upright picture of the scan area, centred in the output size, with margins for ticks
// and ECG.
PictureGeometry pictureGeometry(const Scene& scene);

}  // namespace echocine
