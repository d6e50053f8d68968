#include "motion/mesh/edge_sides.h"

#include <algorithm>

#include "scene/mesh_tags.h"

namespace echocine {

namespace {

Side sideOf(std::span<const Triangle> triangles, std::uint32_t side) {
  const std::uint32_t a = sideStart(triangles, side), b = sideEnd(triangles, side);
  return {edgeKey(a, b), side, a > b};
}

}  // namespace

// Sorted into one group per lower vertex, and within the groups, which are short. A mesh with few
// of its vertices in use is one group.
std::vector<Side> sortedSides(std::span<const Triangle> triangles) {
  const auto count = static_cast<std::uint32_t>(3 * triangles.size());
  std::uint32_t highest = 0;
  for (const Triangle& triangle : triangles)
    highest = std::max(highest, *std::max_element(triangle.begin(), triangle.end()));
  const bool is_dense = highest / 4 <= count;
  const auto groupOf = [&](std::uint32_t side) -> std::size_t {
    return is_dense ? std::min(sideStart(triangles, side), sideEnd(triangles, side)) : 0;
  };
  const std::size_t groups = is_dense ? std::size_t{highest} + 1 : 1;
  std::vector<std::size_t> next(groups + 1, 0);  // place of a group's next side
  for (std::uint32_t side = 0; side < count; ++side) ++next[groupOf(side) + 1];
  for (std::size_t g = 1; g < groups; ++g) next[g] += next[g - 1];
  std::vector<Side> sides(count);
  for (std::uint32_t side = 0; side < count; ++side)
    sides[next[groupOf(side)]++] = sideOf(triangles, side);
  const auto at = [&](std::size_t i) { return sides.begin() + static_cast<std::ptrdiff_t>(i); };
  for (std::size_t g = 0, begin = 0; g < groups; begin = next[g++])
    std::sort(at(begin), at(next[g]), [](const Side& a, const Side& b) {
      return a.key != b.key ? a.key < b.key : a.side < b.side;
    });
  return sides;
}

std::vector<std::uint32_t> oppositeSides(std::span<const Triangle> triangles,
                                         const std::vector<Side>& sides) {
  std::vector<std::uint32_t> opposite(3 * triangles.size(), kNoSide);
  forEachEdge(sides, [&](std::span<const Side> edge) {
    if (edge.size() != 2) return;
    opposite[edge[0].side] = edge[1].side;
    opposite[edge[1].side] = edge[0].side;
  });
  return opposite;
}

Pieces piecesOf(const std::vector<std::uint32_t>& opposite) {
  Pieces pieces{std::vector<std::uint32_t>(opposite.size() / 3, kNoSide)};
  std::vector<std::uint32_t> to_visit;
  for (std::uint32_t first = 0; first < pieces.of_triangle.size(); ++first) {
    if (pieces.of_triangle[first] != kNoSide) continue;
    const std::uint32_t piece = pieces.count++;
    pieces.of_triangle[first] = piece;
    to_visit.assign(1, first);
    while (!to_visit.empty()) {
      const std::uint32_t t = to_visit.back();
      to_visit.pop_back();
      for (std::uint32_t side = 3 * t; side < 3 * t + 3; ++side) {
        if (opposite[side] == kNoSide) continue;
        const std::uint32_t next = opposite[side] / 3;
        if (pieces.of_triangle[next] != kNoSide) continue;
        pieces.of_triangle[next] = piece;
        to_visit.push_back(next);
      }
    }
  }
  return pieces;
}

}  // namespace echocine
