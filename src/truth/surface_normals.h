#pragma once
// Normals of surfaces, and components perpendicular to axes.

#include <span>
#include <vector>

#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// At each vertex the sum of its faces' normals, each with twice the face's area as its length.
inline std::vector<Vec3d> vertexNormals(std::span<const Triangle> triangles,
                                        std::span<const Vec3f> p) {
  std::vector<Vec3d> normals(p.size());
  for (const Triangle& t : triangles) {
    const Vec3d n = cross(toDouble(p[t[1]] - p[t[0]]), toDouble(p[t[2]] - p[t[0]]));
    for (const std::uint32_t v : t) normals[v] = normals[v] + n;
  }
  return normals;
}

// The component of `v` perpendicular to a unit axis.
inline Vec3d acrossAxis(Vec3d v, Vec3d axis) {
  return v - dot(v, axis) * axis;
}

}  // namespace echocine
