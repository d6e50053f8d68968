#pragma once
// Sections of a parametric left ventricle across its long axis.

#include <cmath>
#include <numbers>

#include "motion/heart/left_ventricle.h"

namespace echocine::support {

// Area of the cavity's section at a height (0: ring, 1: apex), its centroid, and the ratio of its
// diameters along x and y turned by an angle about the axis: of the ellipse with its second
// moments.
struct SectionMoments {
  double area_m2 = 0;
  Vec3d centre_m;
  double xx = 0, yy = 0, xy = 0;  // per area
  double diameterRatio(double angle_rad) const {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    return std::sqrt((xx * c * c + 2 * xy * c * s + yy * s * s) /
                     (xx * s * s - 2 * xy * c * s + yy * c * c));
  }
};
inline SectionMoments sectionMoments(const heart::LeftVentricle& left, double zeta) {
  constexpr int kSides = 720;
  const auto at = [&](int i) { return left.cavityAt(2 * std::numbers::pi * i / kSides, zeta); };
  // Sums over the triangles from a point inside to each side.
  const Vec3d inside = 0.5 * (at(0) + at(kSides / 2));
  Vec3d first;
  SectionMoments out;
  for (int i = 0; i < kSides; ++i) {
    const Vec3d a = at(i) - inside, b = at(i + 1) - inside;
    const double part = 0.5 * (a.x * b.y - b.x * a.y);
    out.area_m2 += part;
    first = first + (part / 3) * (a + b);
    out.xx += part / 6 * (a.x * a.x + a.x * b.x + b.x * b.x);
    out.yy += part / 6 * (a.y * a.y + a.y * b.y + b.y * b.y);
    out.xy += part / 12 * (2 * a.x * a.y + a.x * b.y + b.x * a.y + 2 * b.x * b.y);
  }
  const double area = out.area_m2;
  const Vec3d off = (1 / area) * first;
  out.centre_m = inside + off;
  out.xx = out.xx / area - off.x * off.x;
  out.yy = out.yy / area - off.y * off.y;
  out.xy = out.xy / area - off.x * off.y;
  return out;
}

// Equivalent diameter of the cavity's section, m: of the circle with its area.
inline double sectionDiameter(const heart::LeftVentricle& left, double zeta) {
  return 2 * std::sqrt(sectionMoments(left, zeta).area_m2 / std::numbers::pi);
}

}  // namespace echocine::support
