#include "motion/subdivision/refiner.h"

#include <fmt/format.h>
#include <opensubdiv/far/error.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>

#include <cstddef>
#include <vector>

namespace echocine {

namespace {

namespace far_ = OpenSubdiv::Far;
using OpenSubdiv::Sdc::Options;

// About 10 GB with their weights in the library's tables and in ours. Our choice.
constexpr std::size_t kMaxTriangles = 50'000'000;
constexpr double kMaxWeights = 400e6;  // a regular mesh at the triangle limit has 12 x 25 million

// Creases and corners as the descriptor's plain arrays.
struct TagArrays {
  std::vector<int> edges, vertices;
  std::vector<float> edge_sharpness, vertex_sharpness;

  explicit TagArrays(const MeshTags& tags) {
    for (const SharpEdge& e : tags.edges) {
      edges.push_back(static_cast<int>(e.v0));
      edges.push_back(static_cast<int>(e.v1));
      edge_sharpness.push_back(e.sharpness);
    }
    for (const SharpVertex& c : tags.vertices) {
      vertices.push_back(static_cast<int>(c.v));
      vertex_sharpness.push_back(c.sharpness);
    }
  }
};

}  // namespace

std::unique_ptr<far_::TopologyRefiner> makeRefiner(std::span<const Triangle> triangles,
                                                   std::uint32_t vertex_count, const MeshTags& tags,
                                                   const SourcePlace& place) {
  // Errors are reported below; the library would print them.
  far_::SetErrorCallback([](far_::ErrorType, const char*) {});
  far_::SetWarningCallback([](const char*) {});
  const std::vector<int> corner_counts(triangles.size(), 3);
  std::vector<int> corners;
  corners.reserve(3 * triangles.size());
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) corners.push_back(static_cast<int>(v));
  const TagArrays arrays(tags);
  far_::TopologyDescriptor descriptor;
  descriptor.numVertices = static_cast<int>(vertex_count);
  descriptor.numFaces = static_cast<int>(triangles.size());
  descriptor.numVertsPerFace = corner_counts.data();
  descriptor.vertIndicesPerFace = corners.data();
  descriptor.numCreases = static_cast<int>(arrays.edge_sharpness.size());
  descriptor.creaseVertexIndexPairs = arrays.edges.data();
  descriptor.creaseWeights = arrays.edge_sharpness.data();
  descriptor.numCorners = static_cast<int>(arrays.vertex_sharpness.size());
  descriptor.cornerVertexIndices = arrays.vertices.data();
  descriptor.cornerWeights = arrays.vertex_sharpness.data();
  Options scheme;
  scheme.SetVtxBoundaryInterpolation(Options::VTX_BOUNDARY_EDGE_ONLY);
  using Factory = far_::TopologyRefinerFactory<far_::TopologyDescriptor>;
  std::unique_ptr<far_::TopologyRefiner> refiner(
      Factory::Create(descriptor, Factory::Options(OpenSubdiv::Sdc::SCHEME_LOOP, scheme)));
  if (!refiner)
    throw SceneError(atPlace(
        place, "the mesh cannot be subdivided; use subdivision = 0 and normals = \"facet\""));
  return refiner;
}

void checkRefinedSize(std::span<const Triangle> triangles, std::uint32_t vertex_count, int levels,
                      int values, const SourcePlace& place) {
  std::size_t refined = triangles.size();
  for (int level = 0; level < levels && refined <= kMaxTriangles; ++level) refined *= 4;
  if (refined > kMaxTriangles)
    throw SceneError(atPlace(
        place,
        fmt::format("{} levels make more than {} triangles of this mesh's {}; use fewer levels",
                    levels, kMaxTriangles, triangles.size())));
  std::vector<std::uint32_t> faces_at(vertex_count, 0);
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) ++faces_at[v];
  double ring_sum = 0;  // of the faces: vertices in the one-ring, about the sum of valences less 6
  std::uint32_t most = 0;
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) {
      ring_sum += faces_at[v] - 2.0;
      most = std::max(most, faces_at[v]);
    }
  const double vertices_per_face = static_cast<double>(refined / triangles.size()) / 2;
  const double weights = values * vertices_per_face * ring_sum;
  if (weights > kMaxWeights)
    throw SceneError(atPlace(
        place, fmt::format("{} levels need about {:.0f} million weights for this mesh, at most "
                           "{:.0f} million are accepted; use fewer levels or split the vertex at "
                           "which {} faces meet",
                           levels, weights * 1e-6, kMaxWeights * 1e-6, most)));
}

}  // namespace echocine
