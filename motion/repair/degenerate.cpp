#include "motion/repair/degenerate.h"

#include "motion/mesh/coincidence.h"

#include <algorithm>
#include <numeric>

#include "motion/repair/duplicates.h"
#include "motion/repair/flat_faces.h"

namespace echocine {

namespace {

bool namesTwice(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

// Collapses edges without length into their lower vertex and drops faces that use a vertex twice.
std::size_t dropCollapsed(RepairMesh& mesh) {
  std::vector<std::uint32_t> joined(mesh.vertexCount());
  std::iota(joined.begin(), joined.end(), 0u);
  const auto lowest = [&](std::uint32_t v) {
    while (joined[v] != v) v = joined[v] = joined[joined[v]];
    return v;
  };
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      if (!coincide(mesh.positions, mesh.tolerance, t[k], t[(k + 1) % 3])) continue;
      const auto [low, high] = std::minmax({lowest(t[k]), lowest(t[(k + 1) % 3])});
      joined[high] = low;
    }
  std::vector<Triangle> now;
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    Triangle t = mesh.triangles[i];
    for (std::uint32_t& v : t) v = lowest(v);
    if (namesTwice(t)) continue;
    now.push_back(t);
    kept.push_back(i);
  }
  const std::size_t dropped = mesh.triangles.size() - now.size();
  if (dropped > 0) replaceTriangles(mesh, std::move(now), kept);
  return dropped;
}

}  // namespace

DroppedFaces dropDegenerate(RepairMesh& mesh) {
  DroppedFaces dropped;
  dropped.collapsed = dropCollapsed(mesh);
  dropped.duplicates = dropDuplicates(mesh);
  dropped.flipped = mendFlatFaces(mesh);
  return dropped;
}

}  // namespace echocine
