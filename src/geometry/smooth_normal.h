#pragma once
// Interpolated normals of a surface. They are used for the physics of an interface only; facets
// decide which surface a ray crosses, and in which direction.

#include <array>

#include "geometry/crossing_rule.h"

namespace echocine {

// Linear interpolation of one normal per corner over the facet: its values at the ends of the
// facet's cut, with the weights of the cut's points. Not unit. Precondition: `cut` is the result
// for the facet's corners with the heights v0..v2.
TriangleCut cutNormals(const std::array<Vec3f, 3>& at_corner, double v0, double v1, double v2);

// The unit normal of an interpolated value, for a ray: the facet's own normal if the value is zero,
// or if it and the facet face the ray with different sides. That happens at grazing incidence on a
// coarse mesh: the true surface would deflect or miss the ray, but the facets are crossed, and the
// facet's angle, also small, belongs to that crossing. A cosine clamped to 0 would make Eq. 1 a
// total reflection.
Vec3d facingNormal(Vec3d value, Vec3d direction, Vec3d facet_normal);

// Sets a crossing's normal to that between the ends of its cut, and keeps the facet's own.
void makeSmooth(const RayPlanes& ray, const TriangleCut& cut, const TriangleCut& normals,
                Crossing& crossing);

}  // namespace echocine
