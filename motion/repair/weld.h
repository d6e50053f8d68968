#pragma once
// One vertex for each point of a surface.

#include "motion/repair/repair_mesh.h"

namespace echocine {

// Joins coincident vertices on open edges; returns the number removed. A surface without open edges
// is unchanged, so touching parts stay separate and a closed mesh keeps its vertices. A vertex
// keeps the position and order of its lowest index.
std::size_t weldOpenEdges(RepairMesh& mesh);

// Gives each fan of triangles at a bow tie its own vertex; returns the number added.
std::size_t splitBowTies(RepairMesh& mesh);
// The same with given fans: for each corner the lowest of its fan (corner_fans.h).
std::size_t splitFans(RepairMesh& mesh, const std::vector<std::uint32_t>& fans);

}  // namespace echocine
