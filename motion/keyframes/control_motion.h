#pragma once
// The control mesh of one structure over time: its keyframes, and their interpolation at any phase.

#include <string>
#include <vector>

#include "motion/keyframes/interpolation.h"
#include "motion/mesh/mesh.h"

namespace echocine {

struct ControlMotion {
  KeyframeWeights weights;
  std::vector<Triangle> triangles;         // the same in every keyframe
  std::vector<std::vector<Vec3f>> rows_m;  // inputs of `weights`: the keyframes, then derived rows
  std::vector<std::vector<MeshPart>> parts;  // the files of each keyframe
  bool membrane = false;

  bool still() const { return weights.keyframeCount() == 1; }

  // A keyframe's phase returns it exactly. Thread-safe; does not allocate once `positions_m` has
  // the size.
  void at(double phase, std::vector<Vec3f>& positions_m) const;

  // "lv_03.obj", the keyframe's own file without its lids.
  std::string fileOf(std::size_t keyframe) const;
  // "lv_03.obj: face 12", numbered from 1 as in that file, which may be a lid.
  std::string faceName(std::size_t keyframe, std::size_t triangle) const;
};

}  // namespace echocine
