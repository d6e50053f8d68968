#pragma once
// A coarser mesh for display, not for tracing.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// Its vertices are a subset of the original's, so the same subset serves every keyframe of a
// motion.
struct DecimatedMesh {
  std::vector<std::uint32_t> vertices;  // of the original, ascending
  std::vector<Triangle> triangles;      // indices into `vertices`; orientation as before
};

// At most `most_triangles`, if the mesh permits it. Edges are collapsed into one of their ends in
// the order of quadric error (Garland and Heckbert 1997), unless a triangle would be inverted.
// Vertices of open edges stay, so sheets keep their outline. Deterministic. Precondition: triangles
// refer to existing positions.
DecimatedMesh decimated(std::span<const Triangle> triangles, std::span<const Vec3f> positions,
                        std::size_t most_triangles);

}  // namespace echocine
