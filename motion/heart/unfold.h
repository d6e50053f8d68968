#pragma once
// Surfaces that give way to too many neighbours at once fold; here they are smoothed out again.

#include <optional>
#include <span>
#include <vector>

#include "motion/heart/control_mesh.h"

namespace echocine::heart {

// The same surface at every keyframe of a beat.
struct SurfaceBeat {
  std::span<const double> phases;           // ascending from 0, below 1; the first follows the last
  std::vector<std::vector<Vec3d>>& points;  // one entry per phase, or one for what stands still
};

// Where a surface folds.
struct Fold {
  std::size_t keyframe = 0;  // the one at or before it
  std::size_t face = 0;
};

// The first fold of a closed surface at the keyframes and between them, interpolated as a scene is
// that does not say how: two neighbouring faces with more than 140 degrees between their
// normals, or a face more than 70 degrees away from where it looks in both keyframes beside the
// instant. Both are our choice: other kinds of interpolation need room. None where it is sound.
std::optional<Fold> foldIn(const SurfaceBeat& beat, const std::vector<Face>& faces);

// Smooths a closed surface where it folds and near there, and nothing elsewhere. One linear map
// serves all keyframes, so that motion stays as smooth as it was. Returns what it could not mend.
std::optional<Fold> unfold(const SurfaceBeat& beat, const std::vector<Face>& faces);

}  // namespace echocine::heart
