#pragma once
// The sides of a mesh's triangles, grouped by edge.

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "scene/triangle_mesh.h"

namespace echocine {

// Side 3 t + k of a mesh runs from corner k of triangle t to the next one.
inline constexpr std::uint32_t kNoSide = std::numeric_limits<std::uint32_t>::max();

inline std::uint32_t sideStart(std::span<const Triangle> triangles, std::uint32_t side) {
  return triangles[side / 3][side % 3];
}
inline std::uint32_t sideEnd(std::span<const Triangle> triangles, std::uint32_t side) {
  return triangles[side / 3][(side % 3 + 1) % 3];
}
inline std::uint32_t previousSide(std::uint32_t side) {
  return side % 3 == 0 ? side + 2 : side - 1;
}

// Both sides of a common edge have the same key: lower vertex, higher vertex.
struct Side {
  std::uint64_t key;
  std::uint32_t side;
  bool descending;  // runs from the higher to the lower vertex
  std::uint32_t triangle() const { return side / 3; }
};

// Ascending by key, then by side, so the sides of an edge are adjacent.
std::vector<Side> sortedSides(std::span<const Triangle> triangles);

// Calls `visit` with the sides of each edge.
template <typename Visit>
void forEachEdge(const std::vector<Side>& sides, Visit&& visit) {
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].key == sides[begin].key) ++end;
    visit(std::span(sides).subspan(begin, end - begin));
  }
}

// The opposite of each side: the other side of an edge that has two, otherwise kNoSide.
std::vector<std::uint32_t> oppositeSides(std::span<const Triangle> triangles,
                                         const std::vector<Side>& sides);

// Surfaces connected by edges with two faces: a number for each triangle, from 0 in the order of
// their first triangles.
struct Pieces {
  std::vector<std::uint32_t> of_triangle;
  std::uint32_t count = 0;
};
Pieces piecesOf(const std::vector<std::uint32_t>& opposite);

}  // namespace echocine
