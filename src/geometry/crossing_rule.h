#pragma once
// Ray-triangle intersection by an exact rule without gaps or duplicates on shared edges and
// vertices, in double precision and without tolerance.
//
// The ray is the intersection of two planes through it, v = 0 and u = 0. A vertex with v >= 0 is
// above. A triangle with vertices on both sides is cut by v = 0 in two points, one per edge that it
// shares with its neighbours. Both neighbours compute the same point to the last bit, because
// swapping the edge's ends changes only signs (products and sums are rounded separately). The
// triangle is crossed if one cut point has u >= 0 and the other has not. The cuts of a closed mesh
// thus form closed loops, and a loop changes between u >= 0 and u < 0 an even number of times: no
// crossing is lost or duplicated, even if vertices and edges lie exactly on the ray or in the
// plane.
//
// Rays of the imaging plane share their plane v = y, so a triangle's cut serves all of them. The
// plane slice and frame_geometry.h use the same numbers and agree to the last bit.

#include <array>
#include <optional>

#include "core/lanes.h"
#include "geometry/crossing.h"
#include "motion/surfaces/surface_frame.h"

namespace echocine {

// A ray with its two planes. Rays of the imaging plane get v = y exactly.
struct RayPlanes {
  explicit RayPlanes(const Ray& ray);

  Vec3d origin;
  Vec3d u_axis, v_axis, direction;  // right-handed, orthonormal
};

// A triangle's cut by a plane v = 0: a contour edge. For a front face seen along a ray in the plane
// it runs from u >= 0 to u < 0.
struct TriangleCut {
  Vec3d from, to;
};

// The cut of a triangle whose vertices have the heights v. None if all lie on one side.
std::optional<TriangleCut> cutTriangle(Vec3d p0, Vec3d p1, Vec3d p2, double v0, double v1,
                                       double v2);

// The crossing of a ray with a cut by its plane v = 0, at a distance > 0, if any; with the given
// normal.
struct CutCrossing {
  double distance_m = 0;
  bool entering = false;
};
std::optional<CutCrossing> crossCut(const RayPlanes& ray, const TriangleCut& cut);

// On the side from which the triangle's vertices run counter-clockwise; its length is twice the
// area.
inline Vec3d areaNormal(Vec3d p0, Vec3d p1, Vec3d p2) {
  return cross(p1 - p0, p2 - p0);
}

// Unit normal from an area normal. A triangle without area gets the normal of its cut within the
// plane with normal v_axis.
Vec3d facetNormal(Vec3d area_normal, const TriangleCut& cut, Vec3d v_axis);

// The crossing of one triangle, if any. `surface` and `triangle` are passed through.
std::optional<Crossing> crossTriangle(const RayPlanes& ray, Vec3f p0, Vec3f p1, Vec3f p2,
                                      SurfaceId surface, std::uint32_t triangle);

// The same for four triangles at once, in little more than the time of one. Every lane equals
// crossTriangle() to the last bit.
struct LaneCrossings {
  Mask4 crossed, entering;
  Doubles4 distance_m;
  Vec3<Doubles4> normal;  // unit; NaN for a triangle without area
};
LaneCrossings crossTriangles(const RayPlanes& ray, const std::array<Vec3<Floats4>, 3>& corners);

}  // namespace echocine
