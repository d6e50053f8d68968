#pragma once
// Which nodes of the common lattice take part in one group, and where its border points lie among
// them. All places are those of the reference phase.

#include <cstdint>
#include <span>
#include <vector>

#include "core/box.h"
#include "motion/interior/lattice_fit.h"
#include "motion/interior/motion_field.h"
#include "motion/interior/top_surfaces.h"

namespace echocine {

// The lattice that all groups share, over the moving surfaces and what is near them.
struct FieldSpace {
  Box moving;        // the moving surfaces at the reference phase
  double margin_m;   // beyond it the background and still surroundings come to rest
  double spacing_m;  // between nodes
  // Cells all round that of a border point which take part: material may stand out of its surfaces.
  int cells_beyond = 1;
  Vec3d origin() const { return moving.lo - Vec3d{margin_m, margin_m, margin_m}; }
};

struct GroupMembers {
  std::vector<std::uint32_t> surfaces;  // numbers; the count of surfaces for the background
  bool open = false;  // the background, or still surroundings: rests beyond the margin
  bool background = false;
  bool owns(std::uint32_t surface) const;
};

struct GroupCells {
  LatticeGrid grid;
  ActiveNodes nodes;
  // First active node of each slab iy, and the end.
  std::vector<std::uint32_t> slab_starts;
  std::vector<LatticeSample> samples;  // of each point
  std::vector<bool> used;              // cells that hold something of the group, by first node
  std::vector<bool> own;               // active nodes at which the group wins

  Vec3d placeOf(std::size_t node) const;  // of a node of the box, metres
};

// points_m: at least one border point with the group on either side. Nodes take part where the
// group has the highest priority and around its points; nodes of an open group everywhere.
GroupCells layCells(const FieldSpace& space, const GroupMembers& members, const TopSurfaces& tops,
                    std::span<const Vec3f> points_m);

// Active nodes on the sides of their box, by number.
std::vector<std::uint32_t> outermostNodes(const ActiveNodes& nodes);

}  // namespace echocine
