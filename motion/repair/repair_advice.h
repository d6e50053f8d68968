#pragma once
// Which repairs would mend a structure that was refused: found by trying, not by guessing.

#include <optional>
#include <string>
#include <vector>

#include "motion/mesh/mesh_fault.h"
#include "scene/scene.h"

namespace echocine {

// The fewest words of `repair` with which the structure's keyframes pass checkKeyframes, each
// combination tried on the meshes in memory, those first that hold what the scene asks for already;
// nothing where none does. Reads the files anew. A refusal stays cheap: together the trials take at
// most `most_triangles` of all keyframes, what lies beyond is not tried.
inline constexpr std::size_t kMostTriedTriangles = 4'000'000;
std::optional<Repairs> shortestRepair(const Structure& structure, double mesh_unit_m,
                                      std::size_t most_triangles = kMostTriedTriangles);

// repair = ["weld", "fill-holes"], in the order in which they are done; "" without any.
std::string repairWords(const Repairs& repair);

// The refusal of a structure with the repairs in it that mend it, as far as there are any.
std::string advised(const SceneError& refusal, const Structure& structure, double mesh_unit_m);

}  // namespace echocine
