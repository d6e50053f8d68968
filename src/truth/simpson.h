#pragma once
// Volume by Simpson's rule of discs, as in echo laboratories (Lang et al., J. Am. Soc.
// Echocardiogr. 28, 1-39, 2015).

#include <span>
#include <vector>

#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine {

constexpr int kDiscs = 20;

// A cavity's long axis, m.
struct LongAxis {
  Vec3d base_m, apex_m;
};

// Widths of a closed surface at the centres of the discs, in the plane through the axis and
// `across`, m. Precondition: the axis has a length, and `across` is not parallel to it.
std::vector<double> discWidths(std::span<const Triangle> triangles,
                               std::span<const Vec3f> positions_m, const LongAxis& axis,
                               Vec3d across);

// Elliptical discs whose axes are the widths in two planes; pass the same twice for a single plane.
// m^3.
double discVolume(double length_m, std::span<const double> a_m, std::span<const double> b_m);

}  // namespace echocine
