#pragma once
// The part of a cube that the beam reaches across the imaging plane.

#include <algorithm>

#include "core/lanes.h"
#include "speckle/scatterers.h"

namespace echocine {

// A range of v, in steps of kCubeEdge; none if last < first.
struct AcrossRange {
  float first = 2 * kCubeEdge, last = -1;

  AcrossRange() = default;
  // From the corners' distances across, as in BeamCube. Along each of the four edges the place
  // across is a line; between them it lies in their hull.
  explicit AcrossRange(Floats8 across) {
    constexpr float kCut = 1.001f;  // a little beyond, for rounding
    const Floats8 from = __builtin_shufflevector(across, across, 0, 1, 4, 5, 0, 1, 4, 5),
                  slope = __builtin_shufflevector(across, across, 2, 3, 6, 7, 2, 3, 6, 7) - from;
    const Floats8 cuts{-kCut, -kCut, -kCut, -kCut, kCut, kCut, kCut, kCut};
    const Floats8 none{0, 0, 0, 0, 1, 1, 1, 1};
    const Floats8 at = slope > 0 ? (cuts - from) / slope : none;
    first = kCubeEdge * std::min(std::min(at[0], at[1]), std::min(at[2], at[3]));
    last = kCubeEdge * std::max(std::max(at[4], at[5]), std::max(at[6], at[7]));
  }
  void add(const AcrossRange& other) {
    first = std::min(first, other.first);
    last = std::max(last, other.last);
  }
};

}  // namespace echocine
