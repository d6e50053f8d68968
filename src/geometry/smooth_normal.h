#pragma once
// The normal that a surface has between its vertices' normals. It serves the physics of an
// interface only: what a ray crosses, and which way, is decided by the facets.

#include <array>

#include "geometry/crossing_rule.h"

namespace echocine {

// Of a vertex normal per corner, linear over the facet: its values at the ends of the facet's cut.
// They come out of the same weights as the cut's points. Not unit. Precondition: `cut` is what the
// facet's corners with the heights v0..v2 give.
TriangleCut cutNormals(const std::array<Vec3f, 3>& at_corner, double v0, double v1, double v2);

// The unit normal of a value between them, seen along a ray: the facet's own where the value is
// zero, or where it and the facet face the ray with different sides. That happens at grazing
// incidence on a coarse mesh; there the true surface would turn the ray away or not meet it at all,
// the facets say it is crossed, and the facet's angle, small as well, belongs to that crossing. A
// cosine clamped to 0 would make Eq. 1 a total reflection.
Vec3d facingNormal(Vec3d value, Vec3d direction, Vec3d facet_normal);

// A crossing of a cut: takes over the normal between the cut's ends, and keeps the facet's own.
void makeSmooth(const RayPlanes& ray, const TriangleCut& cut, const TriangleCut& normals,
                Crossing& crossing);

}  // namespace echocine
