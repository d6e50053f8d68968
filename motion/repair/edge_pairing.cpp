#include "motion/repair/edge_pairing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace echocine {

namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

struct Leaf {
  double angle;
  std::uint32_t side;
  bool up;  // the face runs the edge from its lower vertex to the higher one
};

// Ascending by angle about the edge, from the first side's face that has an area.
std::vector<Leaf> leavesAround(std::span<const Side> edge, std::span<const Triangle> triangles,
                               std::span<const Vec3d> positions) {
  const Vec3d a = positions[edge.front().key >> 32];
  const Vec3d along = normalised(positions[edge.front().key & 0xFFFFFFFFu] - a);
  const auto across = [&](const Side& side) {
    const Vec3d third = positions[triangles[side.triangle()][(side.side % 3 + 2) % 3]] - a;
    return third - dot(third, along) * along;
  };
  double widest = 0;
  for (const Side& side : edge) widest = std::max(widest, length(across(side)));
  constexpr double kFlat = 1e-6;  // of the widest face: its direction is rounding. Our choice
  const auto from = std::find_if(edge.begin(), edge.end(), [&](const Side& side) {
    return length(across(side)) > kFlat * widest;
  });
  const Vec3d u = across(from == edge.end() ? edge.front() : *from), v = cross(along, u);
  std::vector<Leaf> leaves;
  for (const Side& side : edge) {
    const Vec3d w = across(side);
    const double angle = std::atan2(dot(w, v), dot(w, u));
    leaves.push_back(
        {angle < 0 ? angle + 2 * std::numbers::pi : angle, side.side, !side.descending});
  }
  std::sort(leaves.begin(), leaves.end(), [](const Leaf& l, const Leaf& r) {
    return l.angle != r.angle ? l.angle < r.angle : l.side < r.side;
  });
  return leaves;
}

// The outer normal of an "up" face points to larger angles: the inside lies between a "down" face
// and the next "up" face, like between brackets.
Pairs pairsByInside(const std::vector<Leaf>& leaves) {
  const std::size_t n = leaves.size();
  std::size_t start = 0;
  int depth = 0, least = 0;
  for (std::size_t i = 0; i < n; ++i) {
    depth += leaves[i].up ? -1 : 1;
    if (depth >= least) continue;
    least = depth;
    start = i + 1;  // start after the deepest point, so that no bracket closes before it opens
  }
  Pairs pairs;
  std::vector<std::uint32_t> open;
  for (std::size_t i = 0; i < n; ++i) {
    const Leaf& leaf = leaves[(start + i) % n];
    if (!leaf.up) {
      open.push_back(leaf.side);
      continue;
    }
    pairs.emplace_back(open.back(), leaf.side);
    open.pop_back();
  }
  return pairs;
}

// Pairs of neighbours starting at one of them; the last one of an odd number remains.
Pairs pairsFrom(const std::vector<Leaf>& leaves, std::size_t start, double& angles) {
  const std::size_t n = leaves.size();
  Pairs pairs;
  angles = 0;
  for (std::size_t i = 0; i + 1 < n; i += 2) {
    const Leaf &one = leaves[(start + i) % n], &next = leaves[(start + i + 1) % n];
    const double between = next.angle - one.angle;
    angles += between < 0 ? between + 2 * std::numbers::pi : between;
    pairs.emplace_back(one.side, next.side);
  }
  return pairs;
}

Pairs pairsByAngle(const std::vector<Leaf>& leaves) {
  // An even number of faces has two pairings; an odd one has as many as faces, and only the first
  // few are tried.
  constexpr std::size_t kMostTried = 16;
  const std::size_t tried = leaves.size() % 2 == 0 ? 2 : std::min(leaves.size(), kMostTried);
  double least = 0;
  Pairs best = pairsFrom(leaves, 0, least);
  for (std::size_t start = 1; start < tried; ++start) {
    double angles = 0;
    Pairs pairs = pairsFrom(leaves, start, angles);
    if (angles >= least) continue;
    least = angles;
    best = std::move(pairs);
  }
  return best;
}

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> pairsAround(
    std::span<const Side> edge, std::span<const Triangle> triangles,
    std::span<const Vec3d> positions) {
  const std::vector<Leaf> leaves = leavesAround(edge, triangles, positions);
  const auto up = static_cast<std::size_t>(
      std::count_if(leaves.begin(), leaves.end(), [](const Leaf& leaf) { return leaf.up; }));
  return 2 * up == leaves.size() ? pairsByInside(leaves) : pairsByAngle(leaves);
}

}  // namespace echocine
