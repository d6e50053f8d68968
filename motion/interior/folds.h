#pragma once
// Cells of a group's lattice that turn over, and what keeps them from it.

#include <span>
#include <vector>

#include "motion/interior/group_lattice.h"

namespace echocine {

// Makes the corners of cells stiffer that lose nearly all their volume, or turn over, at a
// keyframe. False when there is none. used: cells that count, by their first active node;
// those that keep half of their volume are taken out. stiffness: by active node.
bool stiffenFolds(const GroupLattice& lattice, std::span<const PhaseClass> classes,
                  std::vector<bool>& used, std::span<float> stiffness);

}  // namespace echocine
