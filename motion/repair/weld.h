#pragma once
// One vertex for each point of a surface.

#include "motion/repair/repair_mesh.h"

namespace echocine {

// Joins vertices at the same place (coincide) that lie on open edges; returns how many went. Where
// a surface is whole nothing is joined, so parts that touch each other stay apart and a closed mesh
// stays as it is. A vertex keeps the place and the order of its lowest number.
std::size_t weldOpenEdges(RepairMesh& mesh);

// Gives every fan of triangles a vertex of its own where several meet in a point only; returns how
// many vertices came.
std::size_t splitBowTies(RepairMesh& mesh);
// The same with the fans given: for each corner the lowest of its fan (corner_fans.h).
std::size_t splitFans(RepairMesh& mesh, const std::vector<std::uint32_t>& fans);

}  // namespace echocine
