#pragma once
// Error of each kind of interpolation at keyframes that it was not given: every other keyframe is
// omitted and interpolated from the rest. For smooth motion the error with all keyframes is
// smaller, by 4 (linear), 8 (Catmull-Rom) or 16 (spline): half the spacing to the power 2, 3 and 4.

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "motion/keyframes/control_motion.h"
#include "scene/names.h"

namespace echocine {

// All kinds.
inline constexpr std::size_t kInterpolationKinds = std::size(NamesOf<Interpolation>::kAll);
inline constexpr auto kInterpolations = [] {
  std::array<Interpolation, kInterpolationKinds> kinds{};
  for (std::size_t k = 0; k < kinds.size(); ++k) kinds[k] = NamesOf<Interpolation>::kAll[k].value;
  return kinds;
}();

// Over all omitted keyframes.
struct InterpolationError {
  std::size_t kept = 0, left_out = 0;           // keyframes
  std::size_t vertices = 0;                     // compared, summed over keyframes
  double vertex_rms_m = 0, vertex_max_m = 0;    // distance
  std::size_t volumes = 0;                      // compared; none for a membrane
  double volume_rms_m3 = 0, volume_max_m3 = 0;  // difference
  double largest_volume_m3 = 0;  // of all keyframes; for a ventricle that of end-diastole
  double volume_max_share = 0;   // volume_max_m3 relative to it
};

// Keeps keyframes 0, 2, 4, ... and omits the others. Phases are unchanged, so with an odd number
// the last gap is half as long as the others. Empty with fewer than four keyframes, and for a kind
// that rejects the uneven spacing of the kept ones.
std::optional<InterpolationError> judgeInterpolation(const ControlMotion& motion,
                                                     Interpolation kind);

// Over several structures: root mean squares over all vertices and volumes, maxima of maxima. The
// relative errors refer to each structure's own largest volume.
InterpolationError pooled(std::span<const InterpolationError> errors);

}  // namespace echocine
