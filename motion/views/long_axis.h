#pragma once
// A ventricle's long axis from its surface.

#include <span>

#include "core/vec3.h"
#include "motion/views/facets.h"

namespace echocine {

// The direction of largest spread of a surface: the first eigenvector of its covariance by area, by
// power iteration; a unit vector of either sign. A non-zero `across` is projected out, which gives
// the second direction. Precondition: at least one facet.
Vec3d principalAxis(std::span<const Facet> surface, Vec3d across = {});

// From the centre of the base to the apex.
struct VentricleAxis {
  Vec3d base, apex;
  double length() const { return echocine::length(apex - base); }
  Vec3d direction() const { return normalised(apex - base); }
};

// For a ventricle with a known base centre, such as the mitral ring's: the apex is the farthest
// part of the cavity. The direction is the mean of the farthest 3 % by area, so that no single
// vertex decides.
VentricleAxis axisFromBase(std::span<const Facet> cavity, Vec3d base);

// From a cavity alone: along its principal axis, with the base at the blunter end. A non-zero
// `towards_base` determines the end.
VentricleAxis axisOfCavity(std::span<const Facet> cavity, Vec3d towards_base = {});

}  // namespace echocine
