#pragma once
// The displacements of all keyframes as a few modes: the fit is linear, so a fit of the modes gives
// that of every keyframe.

#include <span>
#include <vector>

#include "core/vec3.h"

namespace echocine {

struct MotionModes {
  std::size_t count = 0;
  std::vector<std::vector<double>> keyframe_from_mode;  // [keyframe][mode]
  std::vector<Vec3f> shapes_m;                          // [point][mode]: count per point
};

// displacement_m: [point][keyframe], keyframes values per point. Principal components with a root
// mean square over points below `tolerance_m` are omitted. With `blends`, a row per keyframe, the
// modes are those of each keyframe's sum over all, by the shares of its row.
MotionModes motionModes(std::span<const Vec3f> displacement_m, std::size_t keyframes,
                        double tolerance_m, const std::vector<std::vector<double>>& blends = {});

}  // namespace echocine
