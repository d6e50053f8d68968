#pragma once
// The left ventricle of a picture as an echo laboratory traces it: its long axis, and chords across
// it (Lang et al., J. Am. Soc. Echocardiogr. 28, 1-39, 2015).

#include <optional>
#include <span>
#include <vector>

#include "truth/contour.h"

namespace echocine::dataset {

// A cavity in the imaging plane, metres in the probe frame (y = 0).
struct PlaneTracing {
  Vec3d apex, base;  // farthest from the mitral ring's middle; where the axis leaves
  // Across the axis at the ends of kChords - 1 equal parts, from the apex to the base, the side of
  // -cross(axis, y) first.
  std::vector<std::pair<Vec3d, Vec3d>> chords;
  std::vector<double> disc_widths_m;  // at the middles of kDiscs equal parts, from the apex
  double length_m = 0;
};
inline constexpr int kChords = 20;

// outline: of the cavity, closed. Nothing where the ring's middle lies far from it, as in short
// axes: then no long axis is shown. mitral: the middle of the ring, in the plane or near it.
std::optional<PlaneTracing> traceCavity(std::span<const Vec3d> outline, Vec3d mitral);

// The longest of a surface's closed contours; empty: there is none.
std::span<const Vec3d> longestContour(std::span<const Contour> contours, SurfaceId surface);

}  // namespace echocine::dataset
