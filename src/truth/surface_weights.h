#pragma once
// Weights of a surface's vertices that make means over it independent of the mesh density.

#include <span>
#include <vector>

#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// A part of a surface: the region in which a height is 0 or more. The height is given at vertices
// and linear between them. The area of a triangle within the part is assigned to its vertices
// there.
struct SurfacePart {
  std::span<const Triangle> triangles;
  std::span<const Vec3d> points_m;
  std::span<const double> heights;
};

// The area assigned to each vertex, m^2: inside the part, a third of each triangle around it.
std::vector<double> vertexAreas(const SurfacePart& part);

// Adds the length of the part's cut by a plane, m, to the vertices beside it. Each half of a piece
// is divided between the ends of the edge on which it ends; the nearer vertex gets more. `normal`
// is a unit vector.
void addCutLengths(const SurfacePart& part, Vec3d on_m, Vec3d normal,
                   std::vector<double>& weights_m);

// The area-weighted centre of a surface. Precondition: it has an area.
Vec3d surfaceMiddle(std::span<const Triangle> triangles, std::span<const Vec3f> points_m);

// The area-weighted mean direction from `base_m` to the farthest part of the surface: the last 3 %
// of the distance, our choice. The apex lies in this direction, at the distance of the farthest
// vertex.
Vec3d farthestPlace(std::span<const Triangle> triangles, std::span<const Vec3f> points_m,
                    Vec3d base_m);

}  // namespace echocine
