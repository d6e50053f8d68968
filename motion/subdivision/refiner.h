#pragma once
// OpenSubdiv's view of a control mesh under Loop's scheme. Only for the sources of this stage: no
// other header names the library.

#include <opensubdiv/far/topologyRefiner.h>

#include <memory>
#include <span>

#include "core/error.h"
#include "scene/mesh_tags.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// Not yet refined. Open boundaries follow their own vertices. Throws SceneError that starts with
// the place when the library cannot take the mesh.
std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> makeRefiner(std::span<const Triangle> triangles,
                                                              std::uint32_t vertex_count,
                                                              const MeshTags& tags,
                                                              const SourcePlace& place);

// Refuses what would not fit the memory of a workstation, before anything is reserved: triangles
// after the last level, and the weights that make its vertices. A vertex of the last level within a
// control face depends on that face's one-ring, so a single control vertex with thousands of edges
// makes millions of rows of thousands of weights. `values` is how many weights each source takes: 1
// for positions, 2 for tangents. Throws SceneError that starts with the place.
void checkRefinedSize(std::span<const Triangle> triangles, std::uint32_t vertex_count, int levels,
                      int values, const SourcePlace& place);

}  // namespace echocine
