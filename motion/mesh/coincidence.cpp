#include "motion/mesh/coincidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "motion/mesh/edge_sides.h"

namespace echocine {

namespace {

std::vector<char> verticesOnOpenEdges(std::span<const Triangle> triangles, std::size_t vertices) {
  std::vector<char> open(vertices);
  forEachEdge(sortedSides(triangles), [&](std::span<const Side> edge) {
    if (edge.size() > 1) return;
    open[edge.front().key >> 32] = 1;
    open[edge.front().key & 0xFFFFFFFFu] = 1;
  });
  return open;
}

// Vertices of the first keyframe by spatial cells, eight tolerances wide: most points examine one
// cell.
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

double coincidenceTolerance(const std::vector<std::vector<Vec3d>>& positions) {
  double largest = 0;
  for (const std::vector<Vec3d>& keyframe : positions)
    for (const Vec3d& p : keyframe)
      largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  return 4 * double{std::numeric_limits<float>::epsilon()} * largest;
}

bool coincide(const std::vector<std::vector<Vec3d>>& positions, double tolerance, std::uint32_t a,
              std::uint32_t b) {
  return std::all_of(positions.begin(), positions.end(), [&](const auto& places) {
    const Vec3d d = places[a] - places[b];
    return std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) <= tolerance;
  });
}

std::vector<std::uint32_t> coincidentOpenVertices(std::span<const Triangle> triangles,
                                                  const std::vector<std::vector<Vec3d>>& positions,
                                                  double tolerance) {
  const std::vector<Vec3d>& first = positions.front();
  const std::vector<char> open = verticesOnOpenEdges(triangles, first.size());
  std::vector<std::uint32_t> joined(first.size());
  std::iota(joined.begin(), joined.end(), 0u);
  Cells cells(tolerance);
  for (std::uint32_t v = 0; v < first.size(); ++v) {
    if (!open[v]) continue;
    std::uint32_t lowest = v;
    cells.near(first[v], [&](std::uint32_t other) {
      if (other < lowest && coincide(positions, tolerance, other, v)) lowest = other;
    });
    joined[v] = lowest;
    if (lowest == v) cells.add(first[v], v);
  }
  return joined;
}

}  // namespace echocine
