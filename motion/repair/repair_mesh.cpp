#include "motion/repair/repair_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <unordered_map>

#include "core/error.h"
#include "motion/mesh/edge_sides.h"
#include "motion/mesh/mesh_check.h"
#include "motion/mesh/settle_tags.h"

namespace echocine {

namespace {

[[noreturn]] void refuseTag(const std::string& tag, const char* why) {
  throw SceneError(
      fmt::format("{} (vertices count from 0 in tags) {}: remove the tag or the repair", tag, why));
}

std::string tagName(const SharpEdge& e) {
  return fmt::format("crease {} - {}", e.v0, e.v1);
}
std::string tagName(const SharpVertex& c) {
  return fmt::format("corner {}", c.v);
}

// Merged tags must agree.
template <typename Tag>
void settle(std::vector<Tag>& tags) {
  settleTags(tags, std::identity{}, [](const Tag&, const Tag& second) {
    refuseTag(tagName(second), "is joined with one of another sharpness by the repair");
  });
}

using Successors = std::unordered_multimap<std::uint64_t, std::uint64_t>;

// Each key once among those of `from`.
void addSuccessor(Successors& successors, std::uint64_t from, std::uint64_t to) {
  const auto [begin, end] = successors.equal_range(from);
  if (std::none_of(begin, end, [&](const auto& entry) { return entry.second == to; }))
    successors.emplace(from, to);
}

MeshTags movedTags(const MeshTags& tags, const Successors& edges, const Successors& vertices) {
  MeshTags moved;
  for (const SharpEdge& e : tags.edges) {
    const auto [begin, end] = edges.equal_range(edgeKey(e.v0, e.v1));
    if (begin == end) refuseTag(tagName(e), "loses its edge in the repair");
    for (auto to = begin; to != end; ++to)
      moved.edges.push_back({static_cast<std::uint32_t>(to->second >> 32),
                             static_cast<std::uint32_t>(to->second), e.sharpness});
  }
  for (const SharpVertex& c : tags.vertices) {
    const auto [begin, end] = vertices.equal_range(c.v);
    for (auto to = begin; to != end; ++to)
      moved.vertices.push_back({static_cast<std::uint32_t>(to->second), c.sharpness});
  }
  settle(moved.edges);
  settle(moved.vertices);
  return moved;
}

}  // namespace

std::string RepairMesh::faceName(std::size_t triangle) const {
  return echocine::faceName(parts, source[triangle]);
}

void replaceTriangles(RepairMesh& mesh, std::vector<Triangle> now,
                      const std::vector<std::uint32_t>& kept) {
  const bool tagged = std::any_of(mesh.tags.begin(), mesh.tags.end(),
                                  [](const MeshTags& tags) { return !tags.empty(); });
  if (tagged) {
    Successors edges, vertices;
    for (std::size_t i = 0; i < now.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const Triangle& old = mesh.triangles[kept[i]];
        const std::size_t next = (k + 1) % 3;
        addSuccessor(vertices, old[k], now[i][k]);
        if (now[i][k] != now[i][next])
          addSuccessor(edges, edgeKey(old[k], old[next]), edgeKey(now[i][k], now[i][next]));
      }
    for (MeshTags& tags : mesh.tags) tags = movedTags(tags, edges, vertices);
  }
  std::vector<std::uint32_t> source(kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) source[i] = mesh.source[kept[i]];
  mesh.source = std::move(source);
  mesh.triangles = std::move(now);
}

std::size_t dropUnusedVertices(RepairMesh& mesh) {
  constexpr std::uint32_t kUnused = kNoSide;
  std::vector<std::uint32_t> new_number(mesh.vertexCount(), kUnused);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) new_number[v] = 0;
  std::uint32_t used = 0;
  for (std::uint32_t& number : new_number)
    if (number != kUnused) number = used++;
  const std::size_t dropped = mesh.vertexCount() - used;
  if (dropped == 0) return 0;
  for (std::vector<Vec3d>& places : mesh.positions) {
    for (std::size_t v = 0; v < places.size(); ++v)
      if (new_number[v] != kUnused) places[new_number[v]] = places[v];
    places.resize(used);
  }
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = new_number[v];
  for (MeshTags& tags : mesh.tags) {
    for (SharpEdge& e : tags.edges) e = {new_number[e.v0], new_number[e.v1], e.sharpness};
    std::erase_if(tags.vertices, [&](const SharpVertex& c) { return new_number[c.v] == kUnused; });
    for (SharpVertex& c : tags.vertices) c.v = new_number[c.v];
  }
  return dropped;
}

}  // namespace echocine
