#pragma once
// Repairs that would make a rejected structure valid, found by trial.

#include <optional>
#include <string>
#include <vector>

#include "motion/mesh/mesh_fault.h"
#include "scene/scene.h"

namespace echocine {

// The fewest `repair` words with which the structure's keyframes pass checkKeyframes; none if no
// combination works. Combinations are tried in memory, those that include the scene's own words
// first. Reads the files again. The trials process at most `most_triangles` triangles of all
// keyframes, so a rejection stays cheap.
inline constexpr std::size_t kMostTriedTriangles = 4'000'000;
std::optional<Repairs> shortestRepair(const Structure& structure, double mesh_unit_m,
                                      std::size_t most_triangles = kMostTriedTriangles);

// repair = ["weld", "fill-holes"], in the order of execution; "" without any.
std::string repairWords(const Repairs& repair);

// The rejection of a structure, with the repairs that work if there are any.
std::string advised(const SceneError& refusal, const Structure& structure, double mesh_unit_m);

}  // namespace echocine
