#pragma once
// A coarser mesh to be looked at, never to be traced.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// Its vertices are some of the original's, so the same choice serves every keyframe of a motion.
struct DecimatedMesh {
  std::vector<std::uint32_t> vertices;  // of the original, ascending
  std::vector<Triangle> triangles;      // corners are places in `vertices`; oriented as before
};

// At most `most_triangles` where the mesh lets itself be made so coarse: edges are collapsed into
// one of their ends, that of the least quadric error first (Garland and Heckbert 1997), none that
// turns a triangle over. Vertices of open edges stay, so that sheets keep their outline. Equal
// input gives equal output. Precondition: triangles name positions.
DecimatedMesh decimated(std::span<const Triangle> triangles, std::span<const Vec3f> positions,
                        std::size_t most_triangles);

}  // namespace echocine
