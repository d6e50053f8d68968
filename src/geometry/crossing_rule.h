#pragma once
// Does a ray cross a triangle? Decided by a rule that leaves no gap and no double on shared edges and
// vertices, in double precision, without any tolerance.
//
// The ray is the intersection of two planes through it, v = 0 and u = 0. A vertex with v >= 0 is above. A
// triangle with vertices on both sides is cut by v = 0 in two points, one per edge it shares with its
// neighbours; both neighbours compute the same point to the last bit, because swapping the edge's ends
// changes only signs (products and sums are rounded separately). The triangle is crossed when
// one cut point has u >= 0 and the other has not. So the cuts of a closed mesh form closed loops,
// and a loop changes between u >= 0 and u < 0 an even number of times: no crossing is lost or doubled, also
// when vertices and edges lie exactly on the ray or in the plane.

#include <optional>

#include "geometry/crossing.h"
#include "motion/surface_frame.h"

namespace echocine {

// A ray with its two planes. Rays in the imaging plane get v = y exactly.
struct RayPlanes {
  explicit RayPlanes(const Ray& ray);

  Vec3d origin;
  Vec3d u_axis, v_axis, direction;  // right-handed, orthonormal

  double v(Vec3f p) const { return dot(v_axis, toDouble(p) - origin); }
};

// The crossing of one triangle at a distance > 0, if any. `surface` and `triangle` are passed on.
std::optional<Crossing> crossTriangle(const RayPlanes& ray, Vec3f p0, Vec3f p1, Vec3f p2,
                                      SurfaceId surface, std::uint32_t triangle);

}  // namespace echocine
