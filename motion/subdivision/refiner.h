#pragma once
// OpenSubdiv's representation of a control mesh under Loop's scheme. Only for the sources of this
// room: no other header names the library.

#include <opensubdiv/far/topologyRefiner.h>

#include <memory>
#include <span>

#include "core/error.h"
#include "scene/mesh_tags.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// Not yet refined. Open boundaries depend on their own vertices only. Throws SceneError that starts
// with the place if the library rejects the mesh.
std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> makeRefiner(std::span<const Triangle> triangles,
                                                              std::uint32_t vertex_count,
                                                              const MeshTags& tags,
                                                              const SourcePlace& place);

// Rejects sizes beyond the memory of a workstation before allocation: triangles after the last
// level, and the weights of its vertices. A vertex within a control face depends on that face's
// one-ring, so a single control vertex with thousands of edges makes millions of rows of thousands
// of weights. `values`: weights per source, 1 for positions, 2 for tangents. Throws SceneError that
// starts with the place.
void checkRefinedSize(std::span<const Triangle> triangles, std::uint32_t vertex_count, int levels,
                      int values, const SourcePlace& place);

}  // namespace echocine
