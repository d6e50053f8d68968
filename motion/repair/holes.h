#pragma once
// Open rims, and the fans that close them.

#include <optional>

#include "motion/mesh/edge_sides.h"
#include "motion/repair/repair_mesh.h"

namespace echocine {

// A closed loop of open edges, run so that a face on its left would fit the faces at it.
struct Rim {
  std::vector<std::uint32_t> vertices;
  std::uint32_t triangle = 0;  // one at the rim
};

// All rims, in the order of their lowest sides. Where two touch in a vertex, each stays on the fan
// of faces it came from. Nothing where a rim does not close, at edges of three and more faces or
// faces that are not oriented alike. Precondition: `opposite` is that of the triangles.
std::optional<std::vector<Rim>> findRims(std::span<const Triangle> triangles,
                                         const std::vector<std::uint32_t>& opposite);

// The rim's centre of length, whatever the spacing of its vertices.
Vec3d rimMiddle(std::span<const std::uint32_t> rim, std::span<const Vec3d> positions);

struct FilledHoles {
  std::size_t holes = 0, faces = 0;
};

// Closes every rim, by a triangle if it has three edges, else by a fan around its middle; the new
// faces and vertices come last. A rim whose fan is larger than three quarters of the surface it
// closes is that of an open sheet and refused (a bowl of half a sphere takes a half; our choice).
// Does nothing where findRims finds nothing. Throws SceneError without place.
FilledHoles fillHoles(RepairMesh& mesh);

// RepairMesh::source of a face that fills a hole.
inline constexpr std::uint32_t kNoSource = kNoSide;

}  // namespace echocine
