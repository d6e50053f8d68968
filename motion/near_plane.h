#pragma once
// Which triangles of a moving surface the imaging plane can reach at all.

#include <limits>
#include <span>
#include <vector>

#include "motion/surface_frame.h"

namespace echocine {

// How high and how low each vertex stands over the imaging plane, y = 0, at the keyframes.
class HeightRanges {
 public:
  // The vertices at a keyframe, always equally many.
  void add(std::span<const Vec3f> positions_m);

  // In ascending order at least all triangles that have corners on both sides of the plane at any
  // phase. overshoot: KeyframeWeights::overshoot(). What is linear in the keyframes, as subdivision
  // is, may stand in their place.
  std::vector<NumberedTriangle> nearPlane(std::span<const Triangle> triangles,
                                          double overshoot) const;

 private:
  struct Range {
    float lo = std::numeric_limits<float>::infinity(), hi = -lo;
  };
  std::vector<Range> ranges_m_;  // by vertex
};

}  // namespace echocine
