#pragma once
// How well each kind of interpolation would have found keyframes that it was not shown: every other
// keyframe is left out and interpolated from the rest. On smooth motion the error with all
// keyframes is smaller still, by 4 (linear), 8 (Catmull-Rom) or 16 (spline): half the spacing to
// the power 2, 3 and 4.

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "motion/keyframes/control_motion.h"
#include "scene/names.h"

namespace echocine {

// All kinds there are.
inline constexpr std::size_t kInterpolationKinds = std::size(NamesOf<Interpolation>::kAll);
inline constexpr auto kInterpolations = [] {
  std::array<Interpolation, kInterpolationKinds> kinds{};
  for (std::size_t k = 0; k < kinds.size(); ++k) kinds[k] = NamesOf<Interpolation>::kAll[k].value;
  return kinds;
}();

// Over all left-out keyframes.
struct InterpolationError {
  std::size_t kept = 0, left_out = 0;           // keyframes
  std::size_t vertices = 0;                     // that were compared, counted in each keyframe
  double vertex_rms_m = 0, vertex_max_m = 0;    // distance
  std::size_t volumes = 0;                      // that were compared; none of a membrane
  double volume_rms_m3 = 0, volume_max_m3 = 0;  // difference
  double largest_volume_m3 = 0;                 // of all keyframes: end-diastole, of a ventricle
  double volume_max_share = 0;                  // volume_max_m3 of it
};

// Keeps keyframes 0, 2, 4, ... and leaves out the others; the phases stay, so that with an odd
// number the last gap is the given one, half as long as the others. Empty with fewer than four
// keyframes, and for a kind that refuses what is kept because it is spaced too unevenly.
std::optional<InterpolationError> judgeInterpolation(const ControlMotion& motion,
                                                     Interpolation kind);

// Over several structures: root mean squares over all vertices and volumes, largest of the largest.
// The shares are of each structure's own largest volume.
InterpolationError pooled(std::span<const InterpolationError> errors);

}  // namespace echocine
