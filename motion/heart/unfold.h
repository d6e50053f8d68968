#pragma once
// Surfaces that give way to too many neighbours at once fold; here they are smoothed out again.

#include <optional>
#include <vector>

#include "motion/heart/control_mesh.h"

namespace echocine::heart {

// The same surface at every keyframe of a beat, in the order of time. The first follows the last.
using SurfaceBeat = std::vector<std::vector<Vec3d>>;

// Where a surface folds.
struct Fold {
  std::size_t keyframe = 0;  // the one at or before it
  std::size_t face = 0;
};

// The first fold of a closed surface at the keyframes and between them, as straight paths have it:
// two neighbouring faces with more than 140 degrees between their normals, or a face more than 70
// degrees away from where it looks in both keyframes beside the instant. Both are our choice, so
// that paths that are not straight have room. None where the surface is sound.
std::optional<Fold> foldIn(const SurfaceBeat& beat, const std::vector<Face>& faces);

// Smooths a closed surface where it folds and near there, and nothing elsewhere. One linear map
// serves all keyframes, so that motion stays as smooth as it was. Returns what it could not mend.
std::optional<Fold> unfold(SurfaceBeat& beat, const std::vector<Face>& faces);

}  // namespace echocine::heart
