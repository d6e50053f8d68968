#pragma once
// Removes folds of surfaces that yield to many neighbours.

#include <optional>
#include <span>
#include <vector>

#include "motion/heart/control_mesh.h"

namespace echocine::heart {

// The same surface at every keyframe of a beat.
struct SurfaceBeat {
  std::span<const double> phases;           // ascending from 0, below 1; the first follows the last
  std::vector<std::vector<Vec3d>>& points;  // one entry per phase, or one for a static part
};

// Position of a fold.
struct Fold {
  std::size_t keyframe = 0;  // the one at or before it
  std::size_t face = 0;
};

// The first fold of a closed surface at and between keyframes, under the default interpolation: two
// neighbouring faces with more than 140 degrees between their normals, or a face more than 70
// degrees from its direction in both adjacent keyframes. Both are our choice, with a margin for
// other kinds of interpolation. None without folds.
std::optional<Fold> foldIn(const SurfaceBeat& beat, const std::vector<Face>& faces);

// Smooths a closed surface at its folds and near them only. One linear map serves all keyframes, so
// the motion stays as smooth as before. Returns a remaining fold.
std::optional<Fold> unfold(const SurfaceBeat& beat, const std::vector<Face>& faces);

}  // namespace echocine::heart
