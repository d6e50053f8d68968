#pragma once
// Open rims, and fans that close them.

#include <optional>

#include "motion/mesh/edge_sides.h"
#include "motion/repair/repair_mesh.h"

namespace echocine {

// A closed loop of open edges. A face on its left would match the adjacent faces.
struct Rim {
  std::vector<std::uint32_t> vertices;
  std::uint32_t triangle = 0;  // a triangle at the rim
};

// All rims, in the order of their lowest sides. Where two touch in a vertex, each follows the fan
// of faces it came from. None if a rim does not close, at non-manifold edges, or with inconsistent
// orientation. Precondition: `opposite` is that of the triangles.
std::optional<std::vector<Rim>> findRims(std::span<const Triangle> triangles,
                                         const std::vector<std::uint32_t>& opposite);

// The rim's centre weighted by length, independent of the spacing of its vertices.
Vec3d rimMiddle(std::span<const std::uint32_t> rim, std::span<const Vec3d> positions);

struct FilledHoles {
  std::size_t holes = 0, faces = 0;
};

// Closes every rim by a triangle if it has three edges, otherwise by a fan around its centre. New
// faces and vertices come last. A rim whose fan is larger than three quarters of its surface
// belongs to an open sheet and is rejected (a hemisphere takes a half; our choice). Does nothing if
// findRims returns none. Throws SceneError without place.
FilledHoles fillHoles(RepairMesh& mesh);

// RepairMesh::source of a face added over a hole.
inline constexpr std::uint32_t kNoSource = kNoSide;

}  // namespace echocine
