#pragma once
// Removes folds of surfaces that yield to many neighbours.

#include <optional>
#include <span>
#include <vector>

#include "motion/heart/beat_rows.h"
#include "motion/heart/control_mesh.h"
#include "motion/heart/fold_finder.h"

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

// The folds of a closed surface at and between keyframes, under the default interpolation: two
// neighbouring faces with more than 140 degrees between their normals, or a face more than 70
// degrees from its direction in both adjacent keyframes. Both are our choice, with a margin for
// other kinds of interpolation.
class Folds {
 public:
  Folds(const SurfaceBeat& beat, const std::vector<Face>& faces);  // keeps both

  std::optional<Fold> first();  // none without folds

  // Smooths the surface at its folds and near them only, and writes the beat's points. One linear
  // map serves all keyframes, so the motion stays as smooth as before. Returns a remaining fold.
  std::optional<Fold> smooth();

 private:
  const SurfaceBeat& beat_;
  const std::vector<Face>& faces_;
  BeatRows rows_;
  FoldFinder finder_;
};

}  // namespace echocine::heart
