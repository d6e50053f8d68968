#pragma once
// Surfaces in patches: a plane cuts few of them, so only these need to be known exactly.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "motion/surfaces/surface_frame.h"

namespace echocine::fit {

// Vertices of a patch. Our choice: a few millimetres wide, and whole lanes.
inline constexpr std::uint32_t kPatch = 16;

// Sorts vertices so that those of a patch are near each other, each once: halves of the list are
// halves of its longest side, and so on.
void orderByPlace(std::span<const Vec3f> places_m, std::vector<std::uint32_t>& vertices);

// Successive vertices of a surface, which lie near each other.
struct SurfacePatch {
  std::size_t surface;
  std::uint32_t first, end;
  TriangleRange triangles;             // whose first corner is one of them
  std::vector<std::uint32_t> touched;  // its own, and the other corners of their triangles
};
using SurfacePatches = std::shared_ptr<const std::vector<SurfacePatch>>;
// Sorts the triangles by the patch of their first corner.
SurfacePatches patchesOf(std::span<SurfaceTopology> surfaces);

}  // namespace echocine::fit
