#pragma once
// The opening between two cavities: the ring of a valve, detected from the meshes.

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// A part of a cavity's surface and its boundary edges: the ring to which leaflets are attached.
class Orifice {
 public:
  Orifice() = default;
  // Uses the triangles with all corners among `vertices`.
  Orifice(std::span<const Triangle> triangles, std::span<const std::uint32_t> vertices);

  bool empty() const { return rim_.empty(); }

  // Centre of the ring, weighted by length, for vertices at `positions_m`. Precondition: not empty.
  Vec3d middle(std::span<const Vec3f> positions_m) const;

  // The vertex of the ring farthest along `direction` from the ring's centre. Precondition: not
  // empty.
  std::uint32_t farthest(std::span<const Vec3f> positions_m, Vec3d direction) const;

  // Intersection of the ring with the imaging plane (y = 0): the two places farthest apart, the
  // left one first.
  std::optional<std::pair<Vec3d, Vec3d>> hinges(std::span<const Vec3f> positions_m) const;

 private:
  std::vector<std::pair<std::uint32_t, std::uint32_t>> rim_;  // edges by their vertices
};

}  // namespace echocine
