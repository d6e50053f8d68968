#pragma once
// Beam space: both loops resampled to the same angles and depths.

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "echo/echo_loop.h"

namespace echocine::echo {

// Angles from first to last, edges included; depth k is at near + (k + 1/2) (far - near)/samples
// from the apex. Depths are in metres if both loops have a scale, otherwise relative to each loop's
// outer radius.
struct BeamGrid {
  int lines = 0, samples = 0;
  double first_rad = 0, last_rad = 0, near = 0, far = 0;  // rad; metres or relative
  bool metric = false;                                    // depths are metres

  std::size_t size() const {
    return static_cast<std::size_t>(lines) * static_cast<std::size_t>(samples);
  }
  double angle(int line) const {
    return first_rad + (last_rad - first_rad) * line / std::max(1, lines - 1);
  }
  double depth(int sample) const { return near + (sample + 0.5) * (far - near) / samples; }
};

// The common area of both sectors, sampled as finely as the coarser picture. Throws SceneError if
// it is less than a third of the smaller one's angles or depths.
BeamGrid commonGrid(const EchoLoop& synthetic, const EchoLoop& real);

// Pose of beam space in a picture: apex + shift + scale R(rotation) (radius in pixels).
struct Placement {
  double shift_x_px = 0, shift_y_px = 0, scale = 1, rotation_rad = 0;  // scale: a factor
};

struct PicturePoint {
  double x = 0, y = 0;  // pixels
};

// Pixels of `loop` per unit of the grid's depth.
double pixelsPerUnit(const BeamGrid& grid, const EchoLoop& loop);
PicturePoint pictureAt(const BeamGrid& grid, const EchoLoop& loop, const Placement& placement,
                       double angle_rad, double depth);

// Does the picture show echo at a place, in pixels: within the sector and not under an overlay?
bool showsEcho(const EchoLoop& loop, double x, double y);

// 1 for every sample that does, line-major.
PixelPlane validSamples(const BeamGrid& grid, const EchoLoop& loop, const Placement& placement);

// Area weights of the samples that are valid in both, otherwise 0. A sample is weighted by its area
// (proportional to its depth), so sums over beam space are sums over the picture.
std::vector<float> areaWeights(const BeamGrid& grid, const PixelPlane& a, const PixelPlane& b);

// Position of a point among the pixels of a picture: pixel centres at halves; the border is
// extended outside.
struct PixelPlace {
  std::ptrdiff_t at = 0;     // the pixel up and left of it
  float right = 0, low = 0;  // weights of the next column and row
};
inline PixelPlace pixelPlace(int width, int height, double x, double y) {
  const double u = std::clamp(x - 0.5, 0.0, width - 1.0),
               v = std::clamp(y - 0.5, 0.0, height - 1.0);
  const int i = std::min(static_cast<int>(u), width - 2),
            j = std::min(static_cast<int>(v), height - 2);
  return {static_cast<std::ptrdiff_t>(j) * width + i, static_cast<float>(u - i),
          static_cast<float>(v - j)};
}

// Bilinear grey of a picture.
inline float greyAt(const float* picture, int width, const PixelPlace& place) {
  const float *p = picture + place.at, fu = place.right, fv = place.low;
  return (1 - fv) * ((1 - fu) * p[0] + fu * p[1]) + fv * ((1 - fu) * p[width] + fu * p[width + 1]);
}
inline float greyAt(const float* picture, int width, int height, double x, double y) {
  return greyAt(picture, width, pixelPlace(width, height, x, y));
}

}  // namespace echocine::echo
