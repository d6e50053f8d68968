#include "motion/mesh/edge_sides.h"

#include <algorithm>

#include "scene/mesh_tags.h"

namespace echocine {

std::vector<Side> sortedSides(std::span<const Triangle> triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t side = 0; side < 3 * triangles.size(); ++side) {
    const std::uint32_t a = sideStart(triangles, side), b = sideEnd(triangles, side);
    sides.push_back({edgeKey(a, b), side, a > b});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
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
