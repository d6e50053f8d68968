#include "motion/repair/weld.h"

#include <numeric>
#include <unordered_map>

#include "motion/mesh/coincidence.h"
#include "motion/mesh/corner_fans.h"

namespace echocine {

std::size_t weldOpenEdges(RepairMesh& mesh) {
  const std::vector<std::uint32_t> joined =
      coincidentOpenVertices(mesh.triangles, mesh.positions, mesh.tolerance);
  std::size_t count = 0;
  for (std::uint32_t v = 0; v < joined.size(); ++v) count += joined[v] != v;
  if (count == 0) return 0;
  std::vector<Triangle> now = mesh.triangles;
  for (Triangle& t : now)
    for (std::uint32_t& v : t) v = joined[v];
  std::vector<std::uint32_t> all(now.size());
  std::iota(all.begin(), all.end(), 0u);
  replaceTriangles(mesh, std::move(now), all);
  return count;
}

std::size_t splitBowTies(RepairMesh& mesh) {
  return splitFans(mesh, cornerFans(mesh.triangles, sortedSides(mesh.triangles)));
}

std::size_t splitFans(RepairMesh& mesh, const std::vector<std::uint32_t>& fans) {
  std::vector<std::uint32_t> first_fan(mesh.vertexCount(), kNoSide);
  std::unordered_map<std::uint32_t, std::uint32_t> vertex_of_fan;  // of all but a vertex's first
  std::vector<Triangle> now = mesh.triangles;
  const std::size_t before = mesh.vertexCount();
  for (std::uint32_t corner = 0; corner < fans.size(); ++corner) {
    std::uint32_t& v = now[corner / 3][corner % 3];
    if (first_fan[v] == kNoSide) first_fan[v] = fans[corner];
    if (first_fan[v] == fans[corner]) continue;
    const auto [entry, is_new] = vertex_of_fan.try_emplace(
        fans[corner], static_cast<std::uint32_t>(before + vertex_of_fan.size()));
    if (is_new)
      for (std::vector<Vec3d>& places : mesh.positions) places.push_back(Vec3d{places[v]});
    v = entry->second;
  }
  if (vertex_of_fan.empty()) return 0;
  std::vector<std::uint32_t> all(now.size());
  std::iota(all.begin(), all.end(), 0u);
  replaceTriangles(mesh, std::move(now), all);
  return mesh.vertexCount() - before;
}

}  // namespace echocine
