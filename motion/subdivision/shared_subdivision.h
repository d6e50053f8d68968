#pragma once
// Subdivisions, and the normals of their limits, that many meshes of a process share.

#include <memory>

#include "motion/subdivision/limit_normals.h"
#include "motion/subdivision/subdivision.h"

namespace echocine {

// Subdivision(...) of the arguments, or the one that was made of the same before: hearts made from
// dials have the same few topologies, and stencils take longer to make than to apply. The last few
// are kept. Any thread may call it. Throws as Subdivision does.
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
