#pragma once
// The straight sides of a sector, found in the outermost live pixels of its rows.

#include <optional>
#include <vector>

#include "echo/echo_pixels.h"

namespace echocine::echo {

// In pixels; x at the pixel's outer side, y at its middle.
struct EdgePoint {
  double x, y;  // pixels
};

// x = at_zero + slope y: the edges of a sector are steep enough to be written so.
struct EdgeLine {
  double at_zero = 0, slope = 0;  // pixels; pixels per row
  int inliers = 0;                // rows whose outermost pixel lies on it
};

// The outermost live pixel of every row, on the side of `sign` (-1 left, 1 right). A row that
// touches the picture's side shows no edge there.
std::vector<EdgePoint> outermost(const EchoPixels& area, int sign);

// The line that most rows agree on, opening downwards to its side, by random pairs of points and
// then least squares over points within `tolerance` pixels. The same points always give the same
// line; nothing when fewer than eight agree.
std::optional<EdgeLine> edgeLine(const std::vector<EdgePoint>& points, int sign, double tolerance);

}  // namespace echocine::echo
