#include "motion/subdivision/limit_places.h"

#include <array>
#include <cstddef>

#include "scene/mesh_tags.h"

namespace echocine {

namespace {

namespace far_ = OpenSubdiv::Far;

struct Uv {
  float u, v;
};

// A face of some level as a part of its control face.
struct FacePart {
  int control_face;
  std::array<Uv, 3> at;  // of its corners; halves of halves, so exact
};

Uv middle(Uv a, Uv b) {
  return {(a.u + b.u) / 2, (a.v + b.v) / 2};
}

// The position of a child's corner, which came from a vertex or from an edge of the parent.
Uv placeInParent(const far_::TopologyLevel& level, int face, const FacePart& part, int child) {
  const far_::ConstIndexArray vertices = level.GetFaceVertices(face);
  const far_::ConstIndexArray edges = level.GetFaceEdges(face);
  for (int k = 0; k < 3; ++k) {
    const Uv here = part.at[static_cast<std::size_t>(k)];
    if (level.GetVertexChildVertex(vertices[k]) == child) return here;
    // Edge k runs from corner k to the next.
    if (level.GetEdgeChildVertex(edges[k]) == child)
      return middle(here, part.at[static_cast<std::size_t>((k + 1) % 3)]);
  }
  return {};
}

std::vector<FacePart> childParts(const far_::TopologyRefiner& refiner, int parent_level,
                                 const std::vector<FacePart>& parents) {
  const far_::TopologyLevel& level = refiner.GetLevel(parent_level);
  const far_::TopologyLevel& next = refiner.GetLevel(parent_level + 1);
  std::vector<FacePart> parts(static_cast<std::size_t>(next.GetNumFaces()));
  for (int face = 0; face < level.GetNumFaces(); ++face) {
    const FacePart& parent = parents[static_cast<std::size_t>(face)];
    const far_::ConstIndexArray children = level.GetFaceChildFaces(face);
    for (int c = 0; c < children.size(); ++c) {
      FacePart& part = parts[static_cast<std::size_t>(children[c])];
      part.control_face = parent.control_face;
      const far_::ConstIndexArray corners = next.GetFaceVertices(children[c]);
      for (int k = 0; k < 3; ++k)
        part.at[static_cast<std::size_t>(k)] = placeInParent(level, face, parent, corners[k]);
    }
  }
  return parts;
}

// Can the faces at a vertex have different limit normals? Semi-sharp features become smooth after
// some levels, so their limit has one normal.
bool splits(const far_::TopologyLevel& level, int vertex) {
  if (level.IsVertexNonManifold(vertex)) return true;
  if (level.GetVertexSharpness(vertex) >= kInfiniteSharpness) return true;
  const far_::ConstIndexArray edges = level.GetVertexEdges(vertex);
  for (int e = 0; e < edges.size(); ++e)
    if (!level.IsEdgeBoundary(edges[e]) && level.GetEdgeSharpness(edges[e]) >= kInfiniteSharpness)
      return true;
  return false;
}

}  // namespace

LimitPlaces limitPlaces(const far_::TopologyRefiner& refiner) {
  const int control_faces = refiner.GetLevel(0).GetNumFaces();
  std::vector<FacePart> parts;
  for (int face = 0; face < control_faces; ++face)
    parts.push_back({face, {Uv{0, 0}, Uv{1, 0}, Uv{0, 1}}});
  for (int level = 0; level < refiner.GetMaxLevel(); ++level)
    parts = childParts(refiner, level, parts);

  const far_::TopologyLevel& last = refiner.GetLevel(refiner.GetMaxLevel());
  const auto vertex_count = static_cast<std::size_t>(last.GetNumVertices());
  LimitPlaces places;
  places.on_face.resize(static_cast<std::size_t>(control_faces));
  places.normal_count = static_cast<std::uint32_t>(vertex_count);
  places.corners.resize(parts.size());
  std::vector<bool> used(vertex_count, false);
  for (std::size_t face = 0; face < parts.size(); ++face) {
    const far_::ConstIndexArray vertices = last.GetFaceVertices(static_cast<int>(face));
    for (std::size_t k = 0; k < 3; ++k) {
      const int vertex = vertices[static_cast<int>(k)];
      const auto v = static_cast<std::uint32_t>(vertex);
      places.corners[face][k] = v;
      if (used[v]) {
        if (!splits(last, vertex)) continue;
        places.corners[face][k] = places.normal_count++;
        places.split = true;
      }
      used[v] = true;
      places.on_face[static_cast<std::size_t>(parts[face].control_face)].push_back(
          {parts[face].at[k].u, parts[face].at[k].v, places.corners[face][k]});
    }
  }
  return places;
}

}  // namespace echocine
