#pragma once
// Which triangles of a moving surface the imaging plane can reach at all.

#include <span>
#include <vector>

#include "motion/subdivision/subdivision.h"
#include "motion/surfaces/surface_frame.h"

namespace echocine {

// How high and how low each vertex stands over the imaging plane, y = 0, at the keyframes.
class HeightRanges {
 public:
  // The vertices at a keyframe, always equally many.
  void add(std::span<const Vec3f> positions_m);

  // Takes the vertices for control vertices and goes on to the refined ones. These are means of
  // control vertices, weighted by the same numbers from 0 up in every frame, and so are their
  // bounds.
  void refine(const Subdivision& subdivision);

  // In ascending order at least all triangles that have corners on both sides of the plane at any
  // phase. overshoot: KeyframeWeights::overshoot(). Corners may stand `aside_m` beside their place.
  std::vector<NumberedTriangle> nearPlane(std::span<const Triangle> triangles, double overshoot,
                                          double aside_m = 0) const;

 private:
  std::vector<Vec3f> ranges_m_;  // by vertex: x the lowest, y the highest
};

// By vertex: is it a corner of a triangle that the plane can reach? All are, of a surface that does
// not know.
std::vector<bool> verticesNearPlane(const SurfaceTopology& surface);

}  // namespace echocine
