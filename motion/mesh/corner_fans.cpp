#include "motion/mesh/corner_fans.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace echocine {

namespace {

class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  std::uint32_t lowest(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = lowest(a);
    b = lowest(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

// Each corner separately, except for faces that use a vertex twice.
Groups cornersOf(std::span<const Triangle> triangles) {
  Groups fans(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k)
      if (triangles[t][k] == triangles[t][(k + 1) % 3]) fans.join(3 * t + k, 3 * t + (k + 1) % 3);
  return fans;
}

std::uint32_t nextCorner(std::uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

std::vector<std::uint32_t> lowestOf(Groups fans, std::size_t corners) {
  std::vector<std::uint32_t> lowest(corners);
  for (std::uint32_t corner = 0; corner < lowest.size(); ++corner)
    lowest[corner] = fans.lowest(corner);
  return lowest;
}

}  // namespace

std::vector<std::uint32_t> cornerFans(std::span<const Triangle> triangles,
                                      const std::vector<std::uint32_t>& opposite) {
  Groups fans = cornersOf(triangles);
  for (std::uint32_t side = 0; side < opposite.size(); ++side) {
    const std::uint32_t other = opposite[side];
    if (other == kNoSide) continue;
    const bool alike = sideStart(triangles, side) == sideStart(triangles, other);
    fans.join(side, alike ? other : nextCorner(other));
    fans.join(nextCorner(side), alike ? nextCorner(other) : other);
  }
  return lowestOf(std::move(fans), opposite.size());
}

std::vector<std::uint32_t> cornerFans(std::span<const Triangle> triangles,
                                      const std::vector<Side>& sides) {
  Groups fans = cornersOf(triangles);
  // The corner of a side at the lower or the higher vertex of its edge.
  const auto cornerAt = [](const Side& s, bool lower) {
    return lower != s.descending ? s.side : nextCorner(s.side);
  };
  forEachEdge(sides, [&](std::span<const Side> edge) {
    for (const Side& other : edge.subspan(1))
      for (const bool lower : {true, false})
        fans.join(cornerAt(edge.front(), lower), cornerAt(other, lower));
  });
  return lowestOf(std::move(fans), 3 * triangles.size());
}

}  // namespace echocine
