#pragma once
// How far the tissue in each block moves over the beat, so that only blocks that a beam can reach
// are filled with scatterers.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/box.h"
#include "motion/interior/motion_field.h"
#include "speckle/material.h"

namespace echocine {

class BlockReach {
 public:
  BlockReach() = default;  // nothing moves
  // By the field at this many equally spaced phases from 0 on.
  BlockReach(const MotionField& field, int phases);

  // Displacements by a group's field in the block of the lattice that begins at low_m: low and high
  // along each axis, m.
  Box over(Vec3f low_m, const CubeLattice& lattice, std::uint16_t group) const;
  // The most that any node moves in the imaging plane, m.
  double alongPlane() const { return std::sqrt(static_cast<double>(farthest_m2_)); }

 private:
  // Low and high displacements of a node over the beat.
  struct Moves {
    Vec3f low{}, high{};  // no displacement is one of them
    void add(Vec3f d) {
      low = {std::min(low.x, d.x), std::min(low.y, d.y), std::min(low.z, d.z)};
      high = {std::max(high.x, d.x), std::max(high.y, d.y), std::max(high.z, d.z)};
    }
    void add(const Moves& other) {
      add(other.low);
      add(other.high);
    }
  };
  struct GroupMoves {
    LatticeGrid grid;
    std::vector<Moves> of_node;
  };

  void add(const FieldFrame& frame);
  void add(const BlockReach& other);

  std::vector<GroupMoves> groups_;  // by group; no nodes: it does not move
  float farthest_m2_ = 0;
};

}  // namespace echocine
