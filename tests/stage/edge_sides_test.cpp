// Sides are sorted in groups. Here they are sorted at once.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <tuple>
#include <vector>

#include "motion/mesh/edge_sides.h"

namespace echocine {
namespace {

using Row = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, bool>;

std::vector<Row> sortedAtOnce(const std::vector<Triangle>& triangles) {
  std::vector<Row> rows;
  for (std::uint32_t side = 0; side < 3 * triangles.size(); ++side) {
    const std::uint32_t a = triangles[side / 3][side % 3], b = triangles[side / 3][(side + 1) % 3];
    const std::uint32_t end = side % 3 == 2 ? triangles[side / 3][0] : b;
    rows.emplace_back(std::min(a, end), std::max(a, end), side, a > end);
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

void expectSorted(const std::vector<Triangle>& triangles) {
  std::vector<Row> rows;
  for (const Side& side : sortedSides(triangles))
    rows.emplace_back(static_cast<std::uint32_t>(side.key >> 32),
                      static_cast<std::uint32_t>(side.key), side.side, side.descending);
  EXPECT_EQ(rows, sortedAtOnce(triangles));
}

TEST(EdgeSides, AreSortedByEdgeThenBySide) {
  std::mt19937 dice(7);
  for (const std::uint32_t vertices : {1u, 3u, 20u, 300u, 5000u, 4000000000u})
    for (const std::size_t count : {0u, 1u, 40u, 700u}) {
      std::uniform_int_distribution<std::uint32_t> vertex(0, vertices - 1);
      std::vector<Triangle> triangles(count);
      for (Triangle& triangle : triangles)
        for (std::uint32_t& corner : triangle) corner = vertex(dice);
      expectSorted(triangles);
    }
}

// All triangles meet in the first vertex.
TEST(EdgeSides, OfAFanAreOneGroup) {
  std::vector<Triangle> fan;
  for (std::uint32_t v = 1; v < 500; ++v) fan.push_back({0, v, v + 1});
  expectSorted(fan);
}

}  // namespace
}  // namespace echocine
