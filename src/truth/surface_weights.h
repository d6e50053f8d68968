#pragma once
// Weights of a surface's vertices, so that means over it do not depend on how finely it is meshed.

#include <span>
#include <vector>

#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// A part of a surface: where a height, given by vertex and linear between, is 0 or more. The
// area of a triangle in the part counts for its vertices in the part.
struct SurfacePart {
  std::span<const Triangle> triangles;
  std::span<const Vec3d> points_m;
  std::span<const double> heights;
};

// A share of the area of each triangle around a vertex, m^2: a third inside the part.
std::vector<double> vertexAreas(const SurfacePart& part);

// Adds the length of the part's cut by a plane, m, to the vertices beside it: half of each piece
// goes to the ends of the edge that it ends on, the more the nearer. Normal: unit.
void addCutLengths(const SurfacePart& part, Vec3d on_m, Vec3d normal,
                   std::vector<double>& weights_m);

// The middle of a surface by its area. Precondition: it has an area.
Vec3d surfaceMiddle(std::span<const Triangle> triangles, std::span<const Vec3f> points_m);

// The mean direction from `base_m` of the surface that is farthest from it, by area: the last 3 %
// of the distance, our choice. With the distance of the farthest vertex it is the apex.
Vec3d farthestPlace(std::span<const Triangle> triangles, std::span<const Vec3f> points_m,
                    Vec3d base_m);

}  // namespace echocine
