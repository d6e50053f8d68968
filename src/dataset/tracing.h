#pragma once
// The left ventricle of a picture as traced by an echo laboratory: its long axis, and chords across
// it (Lang et al., J. Am. Soc. Echocardiogr. 28, 1-39, 2015).

#include <optional>
#include <span>
#include <vector>

#include "truth/contour.h"

namespace echocine::dataset {

// A cavity in the imaging plane, metres in the probe frame (y = 0).
struct PlaneTracing {
  Vec3d apex,
      base;  // the point farthest from the centre of the mitral ring; the other end of the axis
  // Across the axis at the ends of kChords - 1 equal parts, from the apex to the base; the side of
  // -cross(axis, y) first.
  std::vector<std::pair<Vec3d, Vec3d>> chords;
  std::vector<double> disc_widths_m;  // at the centres of kDiscs equal parts, from the apex
  double length_m = 0;
};
inline constexpr int kChords = 20;

// outline: of the cavity, closed. None if the ring's centre lies far from it, as in short axes,
// which show no long axis. mitral: centre of the ring, in the plane or near it.
std::optional<PlaneTracing> traceCavity(std::span<const Vec3d> outline, Vec3d mitral);

// The longest closed contour of a surface; empty if there is none.
std::span<const Vec3d> longestContour(std::span<const Contour> contours, SurfaceId surface);

}  // namespace echocine::dataset
