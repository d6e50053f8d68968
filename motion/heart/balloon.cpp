#include "motion/heart/balloon.h"

#include <algorithm>
#include <cmath>

#include "motion/heart/smooth.h"

namespace echocine::heart {

Bearing bearingOf(const Meridian& outline, Vec3d direction) {
  const Meridian::Point at = outline.at(shareOf(direction));
  // Turned by an odd angle, so that no edge of the mesh lies in an imaging plane.
  constexpr double kTurn_rad = 0.23;
  const double azimuth_rad = std::atan2(direction.y, direction.x) + kTurn_rad;
  return {at.zeta, at.rho, std::cos(azimuth_rad), std::sin(azimuth_rad)};
}

Balloon::Axes Balloon::axes() const {
  const Vec3d span = roof - ring;
  const double length_m = length(span);
  const Vec3d along = (1 / length_m) * span;
  const Vec3d u = normalised(side - dot(side, along) * along);
  return {length_m, along, u, cross(along, u)};
}

double Balloon::radius(double zeta, double rho, double length_m) const {
  const double grown =
      ring_zone > 0 ? std::lerp(1.0, girth, smoothStep(0, ring_zone, zeta)) : girth;
  return grown * length_m * rho;
}

Vec3d Balloon::centre(double zeta) const {
  const double middle = std::clamp(4 * zeta * (1 - zeta), 0.0, 1.0);
  return ring + zeta * (roof - ring) + middle * bow;
}

double Balloon::radiusTowards(Vec3d point, double zeta) const {
  const Axes a = axes();
  const Vec3d to = point - centre(zeta);
  const double x = dot(to, a.u), y = dot(to, a.v);
  return radius(zeta, outline->rhoAt(zeta), a.length_m) * hypotenuse(x, y) /
         std::max(hypotenuse(x / aspect, y * aspect), 1e-9);
}

std::vector<Vec3d> Balloon::points(std::span<const Bearing> bearings) const {
  const Axes a = axes();
  std::vector<Vec3d> points;
  points.reserve(bearings.size());
  for (const Bearing& at : bearings) {
    const double radius_m = radius(at.zeta, at.rho, a.length_m);
    points.push_back(centre(at.zeta) + radius_m * aspect * at.cos_azimuth * a.u +
                     radius_m / aspect * at.sin_azimuth * a.v);
  }
  return points;
}

void Balloon::pushOut(double gap_m, std::vector<Vec3d>& points) const {
  const Axes a = axes();
  for (Vec3d& p : points) p = pushedOut(p, gap_m, a);
}

Vec3d Balloon::pushedOut(Vec3d p, double gap_m, const Axes& a) const {
  const double zeta = dot(p - ring, a.along) / a.length_m;
  if (zeta < outline->lowest() || zeta > 1) return p;
  const Vec3d from = p - centre(zeta);
  const double x = dot(from, a.u), y = dot(from, a.v);
  const double distance_m = hypotenuse(x / aspect, y * aspect);
  const double limit_m = radius(zeta, outline->rhoAt(zeta), a.length_m) + gap_m;
  constexpr double kRounding_m = 4e-3;
  if (distance_m < 1e-6) return p;
  const double grow = smoothMax(distance_m, limit_m, kRounding_m) / distance_m - 1;
  return p + grow * x * a.u + grow * y * a.v;
}

}  // namespace echocine::heart
