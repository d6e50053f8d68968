#include "motion/mesh/corner_fans.h"

#include <algorithm>
#include <numeric>

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

}  // namespace

std::vector<std::uint32_t> cornerFans(std::span<const Triangle> triangles,
                                      const std::vector<Side>& sides) {
  Groups fans(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)  // faces that name a vertex twice
    for (std::uint32_t k = 0; k < 3; ++k)
      if (triangles[t][k] == triangles[t][(k + 1) % 3]) fans.join(3 * t + k, 3 * t + (k + 1) % 3);
  // The corner of a side at the lower or the higher vertex of its edge.
  const auto cornerAt = [](const Side& s, bool lower) {
    const std::uint32_t start = s.side, end = start % 3 == 2 ? start - 2 : start + 1;
    return lower != s.descending ? start : end;
  };
  forEachEdge(sides, [&](std::span<const Side> edge) {
    for (const Side& other : edge.subspan(1))
      for (const bool lower : {true, false})
        fans.join(cornerAt(edge.front(), lower), cornerAt(other, lower));
  });
  std::vector<std::uint32_t> lowest(3 * triangles.size());
  for (std::uint32_t corner = 0; corner < lowest.size(); ++corner)
    lowest[corner] = fans.lowest(corner);
  return lowest;
}

}  // namespace echocine
