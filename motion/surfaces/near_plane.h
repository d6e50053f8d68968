#pragma once
// Triangles of a moving surface that can reach the imaging plane.

#include <span>
#include <vector>

#include "motion/subdivision/subdivision.h"
#include "motion/surfaces/surface_frame.h"

namespace echocine {

// Range of each vertex's height over the imaging plane, y = 0, over the keyframes.
class HeightRanges {
 public:
  // The vertices at a keyframe, always the same number.
  void add(std::span<const Vec3f> positions_m);

  // Takes the vertices as control vertices and continues with the refined ones. These are means of
  // control vertices with constant non-negative weights, and so are their bounds.
  void refine(const Subdivision& subdivision);

  // A superset of all triangles with corners on both sides of the plane at any phase, in ascending
  // order. overshoot: KeyframeWeights::overshoot(). Corners may be displaced by `aside_m`.
  std::vector<NumberedTriangle> nearPlane(std::span<const Triangle> triangles, double overshoot,
                                          double aside_m = 0) const;

 private:
  std::vector<Vec3f> ranges_m_;  // by vertex: x the lowest, y the highest
};

// By vertex: is it a corner of a triangle that can reach the plane? True for all if unknown.
std::vector<bool> verticesNearPlane(const SurfaceTopology& surface);

}  // namespace echocine
