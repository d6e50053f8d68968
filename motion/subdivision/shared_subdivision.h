#pragma once
// Subdivisions and limit normals shared by the meshes of a process.

#include <memory>

#include "motion/subdivision/limit_normals.h"
#include "motion/subdivision/subdivision.h"

namespace echocine {

// Subdivision(...) of the arguments, or a cached one: parametric hearts have the same few
// topologies, and stencils take longer to compute than to apply. The last few are cached.
// Thread-safe. Throws like Subdivision.
std::shared_ptr<const Subdivision> sharedSubdivision(std::span<const Triangle> triangles,
                                                     std::uint32_t vertex_count,
                                                     const MeshTags& tags, int levels,
                                                     const SourcePlace& place);

// The same for LimitNormals.
std::shared_ptr<const LimitNormals> sharedLimitNormals(std::span<const Triangle> triangles,
                                                       std::uint32_t vertex_count,
                                                       const MeshTags& tags, int levels,
                                                       const SourcePlace& place);

}  // namespace echocine
