#include "motion/repair/duplicates.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <unordered_map>

#include "motion/mesh/edge_sides.h"

namespace echocine {

namespace {

// The faces that share all corners, lowest first, and whether both orientations are equally
// frequent.
struct Twins {
  std::vector<std::uint32_t> faces;
  bool opposed = false;
};

// Even permutations of the sorted corners run one way, odd ones the other.
bool runsUp(const Triangle& t) {
  return (t[0] < t[1]) + (t[1] < t[2]) + (t[2] < t[0]) == 2;
}

std::vector<Twins> findTwins(const RepairMesh& mesh) {
  const auto sorted = [&](std::uint32_t i) {
    Triangle t = mesh.triangles[i];
    std::sort(t.begin(), t.end());
    return t;
  };
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Triangle ta = sorted(a), tb = sorted(b);
    return ta != tb ? ta < tb : a < b;
  });
  std::vector<Twins> all;
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && sorted(order[end]) == sorted(order[begin])) ++end;
    if (end - begin < 2) continue;
    Twins twins;
    std::size_t up = 0;
    for (std::size_t i = begin; i < end; ++i) {
      twins.faces.push_back(order[i]);
      up += runsUp(mesh.triangles[order[i]]);
    }
    twins.opposed = 2 * up == end - begin;
    all.push_back(std::move(twins));
  }
  return all;
}

// Opposite duplicates that are connected form a patch. It is a fin, to be removed on both sides, if
// it is joined to single faces and every edge of it has an even number of faces.
class Fins {
 public:
  Fins(const RepairMesh& mesh, const std::vector<Twins>& all)
      : patch_(all.size()), odd_(all.size()), joined_(all.size()) {
    std::iota(patch_.begin(), patch_.end(), 0u);
    std::unordered_map<std::uint32_t, std::uint32_t> twins_of;
    for (std::uint32_t i = 0; i < all.size(); ++i)
      if (all[i].opposed)
        for (const std::uint32_t face : all[i].faces) twins_of[face] = i;
    if (twins_of.empty()) return;
    forEachEdge(sortedSides(mesh.triangles), [&](std::span<const Side> edge) {
      std::optional<std::uint32_t> first;
      bool single = false;
      for (const Side& side : edge) {
        const auto found = twins_of.find(side.triangle());
        single = single || found == twins_of.end();
        if (found == twins_of.end()) continue;
        if (first) unite(*first, found->second);
        first = found->second;
      }
      if (!first) return;
      odd_[*first] |= edge.size() % 2;
      joined_[*first] |= single;
    });
    for (std::uint32_t i = 0; i < all.size(); ++i) {
      odd_[patch(i)] |= odd_[i];
      joined_[patch(i)] |= joined_[i];
    }
  }
  bool isFin(std::uint32_t twins) { return joined_[patch(twins)] && !odd_[patch(twins)]; }

 private:
  std::uint32_t patch(std::uint32_t i) {
    while (patch_[i] != i) i = patch_[i] = patch_[patch_[i]];
    return i;
  }
  void unite(std::uint32_t a, std::uint32_t b) { patch_[patch(a)] = patch(b); }

  std::vector<std::uint32_t> patch_;
  std::vector<char> odd_, joined_;
};

}  // namespace

std::size_t dropDuplicates(RepairMesh& mesh) {
  const std::vector<Twins> all = findTwins(mesh);
  if (all.empty()) return 0;
  Fins fins(mesh, all);
  std::vector<char> dropped(mesh.triangles.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    const bool both = all[i].opposed && fins.isFin(i);
    for (const std::uint32_t face : all[i].faces)
      dropped[face] = both || face != all[i].faces.front();
  }
  std::vector<Triangle> now;
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    if (dropped[i]) continue;
    now.push_back(mesh.triangles[i]);
    kept.push_back(i);
  }
  const std::size_t count = mesh.triangles.size() - now.size();
  replaceTriangles(mesh, std::move(now), kept);
  return count;
}

}  // namespace echocine
