#include "motion/repair/flat_faces.h"

#include <algorithm>
#include <unordered_set>

#include "motion/mesh/edge_sides.h"

namespace echocine {

namespace {

// Flips long edges of flat faces.
class FlatFaces {
 public:
  explicit FlatFaces(RepairMesh& mesh) : mesh_(mesh) {
    for (const MeshTags& tags : mesh.tags)
      for (const SharpEdge& e : tags.edges) creases_.insert(edgeKey(e.v0, e.v1));
  }

  // One pass; flipped faces are not processed again in it.
  std::size_t turn() {
    std::vector<std::uint32_t> flat;
    for (std::uint32_t i = 0; i < mesh_.triangles.size(); ++i)
      if (isFlat(mesh_.triangles[i])) flat.push_back(i);
    if (flat.empty()) return 0;
    const std::vector<Side> sides = sortedSides(mesh_.triangles);
    edges_.clear();
    for (const Side& side : sides) edges_.insert(side.key);
    opposite_ = oppositeSides(mesh_.triangles, sides);
    std::unordered_set<std::uint32_t> turned;
    std::size_t count = 0;
    for (const std::uint32_t face : flat) {
      const std::uint32_t side = longestSide(face), across = opposite_[side];
      if (across == kNoSide || turned.contains(face) || turned.contains(across / 3)) continue;
      if (!flip(side, across)) continue;
      turned.insert({face, across / 3});
      ++count;
    }
    return count;
  }

 private:
  Vec3d at(std::size_t keyframe, std::uint32_t v) const { return mesh_.positions[keyframe][v]; }

  // The smallest height of the triangle is within the tolerance in every keyframe.
  bool isFlat(const Triangle& t) const {
    for (std::size_t k = 0; k < mesh_.positions.size(); ++k)
      if (!isFlat(t, k)) return false;
    return true;
  }
  bool isFlat(const Triangle& t, std::size_t keyframe) const {
    const Vec3d a = at(keyframe, t[0]), b = at(keyframe, t[1]), c = at(keyframe, t[2]);
    const double longest = std::max({length(b - a), length(c - b), length(a - c)});
    return length(cross(b - a, c - a)) <= mesh_.tolerance * longest;
  }

  std::uint32_t longestSide(std::uint32_t face) const {
    std::uint32_t best = 3 * face;
    const auto lengthOf = [&](std::uint32_t side) {
      return length(at(0, sideEnd(mesh_.triangles, side)) -
                    at(0, sideStart(mesh_.triangles, side)));
    };
    for (std::uint32_t side = best + 1; side < 3 * face + 3; ++side)
      if (lengthOf(side) > lengthOf(best)) best = side;
    return best;
  }

  // Side p -> q of the flat face p q r and the other face's q -> p, apex s, become p s r and s q r.
  bool flip(std::uint32_t side, std::uint32_t across) {
    const auto& triangles = mesh_.triangles;
    const std::uint32_t p = sideStart(triangles, side), q = sideEnd(triangles, side);
    const std::uint32_t r = sideStart(triangles, previousSide(side));
    const std::uint32_t s = sideStart(triangles, previousSide(across));
    const bool alike = sideStart(triangles, across) == q;  // both faces have the same orientation
    if (!alike || r == s || edges_.contains(edgeKey(r, s)) || creases_.contains(edgeKey(p, q)))
      return false;
    const Triangle one{p, s, r}, other{s, q, r};
    for (std::size_t k = 0; k < mesh_.positions.size(); ++k)
      if (isFlat(one, k) || isFlat(other, k)) return false;
    mesh_.triangles[side / 3] = one;
    mesh_.triangles[across / 3] = other;
    edges_.insert(edgeKey(r, s));
    return true;
  }

  RepairMesh& mesh_;
  std::unordered_set<std::uint64_t> creases_, edges_;
  std::vector<std::uint32_t> opposite_;
};

}  // namespace

std::size_t mendFlatFaces(RepairMesh& mesh) {
  // Adjacent flat faces are repaired one after the other, from their rim. Our choice.
  constexpr int kPasses = 8;
  FlatFaces flat(mesh);
  std::size_t mended = 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    const std::size_t turned = flat.turn();
    mended += turned;
    if (turned == 0) break;
  }
  return mended;
}

}  // namespace echocine
