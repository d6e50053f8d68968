#pragma once
// One group's lattice: what is fitted to its nodes, and their rows of displacements by keyframe.

#include <cstdint>
#include <span>
#include <vector>

#include "motion/interior/border_points.h"
#include "motion/interior/group_cells.h"
#include "motion/interior/motion_modes.h"

namespace echocine {

// Surfaces that share their phases share a list of keyframes and the modes of its displacements.
struct PhaseClass {
  KeyframeWeights weights;
  MotionModes modes;                // shapes of this class's points, in the points' order
  std::vector<std::int32_t> order;  // by border point: its place among the shapes, -1 of another
};

struct GroupLattice {
  LatticeGrid grid;
  ActiveNodes nodes;
  // First active node of each slab iy, and the end.
  std::vector<std::uint32_t> slab_starts;
  // By phase class, by row of its weights, by active node; empty where no keyframe moves the group.
  std::vector<std::vector<std::vector<Vec3f>>> rows_m;
  double residual = 0;  // LatticeFit::Solution::residual
};

// Fits a group to the border points that have it on either side. Empty if none of them moves.
GroupLattice fitGroup(const FieldSpace& space, const GroupMembers& members, const TopSurfaces& tops,
                      std::span<const BorderPoint> points, std::span<const PhaseClass> classes);

}  // namespace echocine
