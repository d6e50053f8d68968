#pragma once
// One group's lattice: which nodes take part, what is fitted to them, and their rows of
// displacements by keyframe.

#include <cstdint>
#include <span>
#include <vector>

#include "motion/interior/border_points.h"
#include "motion/interior/lattice_fit.h"
#include "motion/interior/motion_modes.h"

namespace echocine {

// The lattice that all groups share, over the moving surfaces and what is near them.
struct FieldSpace {
  Box moving;        // the moving surfaces at the reference phase
  double margin_m;   // beyond it the background and still surroundings come to rest
  double spacing_m;  // between nodes
  Vec3d origin() const { return moving.lo - Vec3d{margin_m, margin_m, margin_m}; }
};

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
};

struct GroupMembers {
  std::vector<std::uint32_t> surfaces;  // numbers; the count of surfaces for the background
  bool open = false;  // the background, or still surroundings: rests beyond the margin
  bool owns(std::uint32_t surface) const;
};

// Fits a group to the border points on either side of which it stands. Empty without one that
// moves.
GroupLattice fitGroup(const FieldSpace& space, const GroupMembers& members, const Winners& winners,
                      std::span<const BorderPoint> points, std::span<const PhaseClass> classes);

}  // namespace echocine
