#pragma once
// How far a group moves across the imaging plane.

#include <span>

#include "motion/interior/group_lattice.h"

namespace echocine {

// The most that a node moves along y, with the interpolation's overshoot between keyframes; m.
double reachAcross(const GroupLattice& lattice, std::span<const PhaseClass> classes);

}  // namespace echocine
