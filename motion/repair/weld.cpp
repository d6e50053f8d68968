#include "motion/repair/weld.h"

#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "motion/repair/corner_fans.h"

namespace echocine {

namespace {

std::vector<char> verticesOnOpenEdges(const RepairMesh& mesh) {
  std::vector<char> open(mesh.vertexCount());
  forEachEdge(sortedSides(mesh.triangles), [&](std::span<const Side> edge) {
    if (edge.size() > 1) return;
    open[edge.front().key >> 32] = 1;
    open[edge.front().key & 0xFFFFFFFFu] = 1;
  });
  return open;
}

// Vertices of the first keyframe by cells of space, eight tolerances wide: most points look into
// one.
class Cells {
 public:
  explicit Cells(double tolerance) : tolerance_(tolerance), width_(8 * tolerance) {}

  void add(Vec3d p, std::uint32_t vertex) {
    vertices_.emplace(key(cell(p.x), cell(p.y), cell(p.z)), vertex);
  }

  // Calls `visit` with every vertex within the tolerance, and some others.
  template <typename Visit>
  void near(Vec3d p, Visit&& visit) const {
    const Vec3d reach{tolerance_, tolerance_, tolerance_};
    const Vec3d lo = p - reach, hi = p + reach;
    for (std::int64_t x = cell(lo.x); x <= cell(hi.x); ++x)
      for (std::int64_t y = cell(lo.y); y <= cell(hi.y); ++y)
        for (std::int64_t z = cell(lo.z); z <= cell(hi.z); ++z) {
          const auto [begin, end] = vertices_.equal_range(key(x, y, z));
          for (auto entry = begin; entry != end; ++entry) visit(entry->second);
        }
  }

 private:
  std::int64_t cell(double coordinate) const {
    return width_ > 0 ? static_cast<std::int64_t>(std::floor(coordinate / width_)) : 0;
  }
  static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
    std::uint64_t hash = 0;
    for (const std::int64_t c : {x, y, z})
      hash = (hash ^ static_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15u;
    return hash ^ (hash >> 29);
  }

  double tolerance_, width_;
  std::unordered_multimap<std::uint64_t, std::uint32_t> vertices_;
};

}  // namespace

std::size_t weldOpenEdges(RepairMesh& mesh) {
  const std::vector<char> open = verticesOnOpenEdges(mesh);
  std::vector<std::uint32_t> joined(mesh.vertexCount());
  std::iota(joined.begin(), joined.end(), 0u);
  Cells cells(mesh.tolerance);
  std::size_t count = 0;
  for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
    if (!open[v]) continue;
    std::uint32_t lowest = v;
    cells.near(mesh.positions.front()[v], [&](std::uint32_t other) {
      if (other < lowest && coincide(mesh, other, v)) lowest = other;
    });
    joined[v] = lowest;
    if (lowest == v)
      cells.add(mesh.positions.front()[v], v);
    else
      ++count;
  }
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
  const auto fans = cornerFans(mesh.triangles, sortedSides(mesh.triangles));
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
