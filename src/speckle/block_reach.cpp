#include "speckle/block_reach.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace echocine {

namespace {

// Nodes of a lattice along one axis whose displacements a stretch can take: those round it, and
// outside the lattice the ones on its border.
struct NodeRange {
  int first, last;
};
NodeRange nodesAbout(float low_m, float edge_m, float origin_m, float spacing_m, int count) {
  const float low = (low_m - origin_m) / spacing_m, high = low + edge_m / spacing_m;
  const auto held = [&](float node) {
    return static_cast<int>(std::clamp(node, 0.0f, static_cast<float>(count - 1)));
  };
  constexpr float kRounding = 1e-3f;
  return {held(std::floor(low - kRounding)), held(std::ceil(high + kRounding))};
}

}  // namespace

// Least and greatest values do not depend on the order of the phases.
BlockReach::BlockReach(const MotionField& field, int phases) {
  constexpr int kTogether = 8;
  std::vector<BlockReach> parts(static_cast<std::size_t>((phases + kTogether - 1) / kTogether));
  parallelBlocks(static_cast<std::size_t>(phases), kTogether,
                 [&](std::size_t begin, std::size_t end) {
                   BlockReach& part = parts[begin / kTogether];
                   FieldFrame frame;
                   for (std::size_t i = begin; i < end; ++i) {
                     field.at(static_cast<double>(i) / phases, frame);
                     part.add(frame);
                   }
                 });
  for (const BlockReach& part : parts) add(part);
}

void BlockReach::add(const FieldFrame& frame) {
  groups_.resize(frame.groups.size());
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const std::vector<Vec3f>& d_m = frame.groups[g].displacement_m;
    groups_[g].grid = frame.groups[g].grid;
    groups_[g].of_node.resize(d_m.size());
    for (std::size_t n = 0; n < d_m.size(); ++n) {
      groups_[g].of_node[n].add(d_m[n]);
      farthest_m2_ = std::max(farthest_m2_, d_m[n].x * d_m[n].x + d_m[n].z * d_m[n].z);
    }
  }
}

void BlockReach::add(const BlockReach& other) {
  farthest_m2_ = std::max(farthest_m2_, other.farthest_m2_);
  if (groups_.empty()) groups_ = other.groups_;
  for (std::size_t g = 0; g < groups_.size(); ++g)
    for (std::size_t n = 0; n < groups_[g].of_node.size(); ++n)
      groups_[g].of_node[n].add(other.groups_[g].of_node[n]);
}

Box BlockReach::over(Vec3f low_m, const CubeLattice& lattice, std::uint16_t group_number) const {
  Moves all;
  if (const GroupMoves& group = groups_[group_number]; !group.of_node.empty()) {
    const LatticeGrid& grid = group.grid;
    const auto about = [&](float low, float origin, int count) {
      return nodesAbout(low, lattice.block_m, origin, grid.spacing_m, count);
    };
    const NodeRange xs = about(low_m.x, grid.origin_m.x, grid.nx),
                    ys = about(low_m.y, grid.origin_m.y, grid.ny),
                    zs = about(low_m.z, grid.origin_m.z, grid.nz);
    for (int iy = ys.first; iy <= ys.last; ++iy)
      for (int iz = zs.first; iz <= zs.last; ++iz)
        for (int ix = xs.first; ix <= xs.last; ++ix) all.add(group.of_node[grid.at(ix, iy, iz)]);
  }
  Box box;
  box.add(toDouble(all.low));
  box.add(toDouble(all.high));
  return box;
}

}  // namespace echocine
