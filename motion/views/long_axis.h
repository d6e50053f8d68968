#pragma once
// A ventricle's long axis, found from the vertices of its surface.

#include <span>

#include "core/vec3.h"

namespace echocine {

// The direction in which points are spread most: the first eigenvector of their covariance, by
// power iteration; a unit vector of either sign. `across`, where not zero, is kept out of it, so
// that the second one can be asked for. Precondition: at least one point.
Vec3d principalAxis(std::span<const Vec3d> points, Vec3d across = {});

// From the middle of the base to the apex.
struct VentricleAxis {
  Vec3d base, apex;
  double length() const { return echocine::length(apex - base); }
  Vec3d direction() const { return normalised(apex - base); }
};

// Of a ventricle whose base's middle, such as the mitral ring's, is known: the apex is where the
// cavity reaches farthest from it. The direction is the mean of the farthest 3 %, so that no single
// vertex decides.
VentricleAxis axisFromBase(std::span<const Vec3d> cavity, Vec3d base);

// Of a cavity alone: along its principal axis, the base at the blunter end. `towards_base`, where
// not zero, says which end that is.
VentricleAxis axisOfCavity(std::span<const Vec3d> cavity, Vec3d towards_base = {});

}  // namespace echocine
