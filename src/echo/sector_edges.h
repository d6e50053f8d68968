#pragma once
// The straight edges of a sector, from the outermost live pixels of its rows.

#include <optional>
#include <vector>

#include "echo/echo_pixels.h"

namespace echocine::echo {

// In pixels; x at the pixel's outer edge, y at its centre.
struct EdgePoint {
  double x, y;  // pixels
};

// x = at_zero + slope y: the edges of a sector are steep enough for this form.
struct EdgeLine {
  double at_zero = 0, slope = 0;  // pixels; pixels per row
  int inliers = 0;                // rows whose outermost pixel lies on the line
};

// The outermost live pixel of every row, on the side of `sign` (-1 left, 1 right). Rows that touch
// the picture's border are omitted.
std::vector<EdgePoint> outermost(const EchoPixels& area, int sign);

// The line with most inliers, opening downwards to its side: random pairs of points, then least
// squares over points within `tolerance` pixels. Deterministic; none with fewer than eight inliers.
std::optional<EdgeLine> edgeLine(const std::vector<EdgePoint>& points, int sign, double tolerance);

}  // namespace echocine::echo
