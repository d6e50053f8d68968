#pragma once
// Subdivisions that many meshes of a process share.

#include <memory>

#include "motion/subdivision/subdivision.h"

namespace echocine {

// Subdivision(...) of the arguments, or the one that was made of the same before: hearts made from
// dials have the same few topologies, and stencils take longer to make than to apply. The last few
// are kept. Any thread may call it. Throws as Subdivision does.
std::shared_ptr<const Subdivision> sharedSubdivision(std::span<const Triangle> triangles,
                                                     std::uint32_t vertex_count,
                                                     const MeshTags& tags, int levels,
                                                     const SourcePlace& place);

}  // namespace echocine
