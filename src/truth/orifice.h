#pragma once
// Where one cavity opens into another: the ring of a valve, found from the meshes.

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// A part of a cavity's surface and the edges that bound it: the ring where leaflets hinge.
class Orifice {
 public:
  Orifice() = default;
  // Of the triangles of which all corners are among `vertices`.
  Orifice(std::span<const Triangle> triangles, std::span<const std::uint32_t> vertices);

  bool empty() const { return rim_.empty(); }

  // The middle of the ring, by length, when the surface's vertices stand at `positions_m`.
  // Precondition: not empty.
  Vec3d middle(std::span<const Vec3f> positions_m) const;

  // The vertex of the ring that is farthest along `direction` from the ring's middle.
  // Precondition: not empty.
  std::uint32_t farthest(std::span<const Vec3f> positions_m, Vec3d direction) const;

  // Where the ring cuts the imaging plane (y = 0): the two places farthest apart, the left one
  // first.
  std::optional<std::pair<Vec3d, Vec3d>> hinges(std::span<const Vec3f> positions_m) const;

 private:
  std::vector<std::pair<std::uint32_t, std::uint32_t>> rim_;  // edges by their vertices
};

}  // namespace echocine
