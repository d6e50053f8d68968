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

Doubles4 Balloon::radius(Doubles4 zeta, Doubles4 rho, double length_m) const {
  const Doubles4 all = Doubles4{} + girth;
  const Doubles4 grown =
      ring_zone > 0 ? blended(Doubles4{} + 1, all, smoothStep(0, ring_zone, zeta)) : all;
  return grown * length_m * rho;
}

FourPoints Balloon::centre(Doubles4 zeta) const {
  const Doubles4 middle = clamped(4 * zeta * (1 - zeta), Doubles4{}, Doubles4{} + 1);
  return inAllLanes(ring) + zeta * inAllLanes(roof - ring) + middle * inAllLanes(bow);
}

double Balloon::radius(double zeta, double rho, double length_m) const {
  return radius(Doubles4{} + zeta, Doubles4{} + rho, length_m)[0];
}

Vec3d Balloon::centre(double zeta) const {
  const FourPoints same = centre(Doubles4{} + zeta);
  return {same.x[0], same.y[0], same.z[0]};
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
  const FourPoints u = inAllLanes(a.u), v = inAllLanes(a.v);
  std::vector<Vec3d> points(bearings.size());
  for (std::size_t i = 0; i < points.size(); i += kDoubleLanes) {
    Doubles4 zeta, rho, cos_azimuth, sin_azimuth;
    for (std::size_t lane = 0; lane < kDoubleLanes; ++lane) {
      const Bearing& at = bearings[std::min(i + lane, bearings.size() - 1)];
      zeta[lane] = at.zeta, rho[lane] = at.rho;
      cos_azimuth[lane] = at.cos_azimuth, sin_azimuth[lane] = at.sin_azimuth;
    }
    const Doubles4 radius_m = radius(zeta, rho, a.length_m);
    put(centre(zeta) + radius_m * aspect * cos_azimuth * u + radius_m / aspect * sin_azimuth * v,
        points, i);
  }
  return points;
}

void Balloon::pushOut(double gap_m, std::vector<Vec3d>& points) const {
  const Axes a = axes();
  for (std::size_t i = 0; i < points.size(); i += kDoubleLanes)
    put(pushedOut(fourPointsAt(points, i), gap_m, a), points, i);
}

FourPoints Balloon::pushedOut(const FourPoints& p, double gap_m, const Axes& a) const {
  const FourPoints u = inAllLanes(a.u), v = inAllLanes(a.v);
  const Doubles4 zeta = dot(p - inAllLanes(ring), inAllLanes(a.along)) / a.length_m;
  const Mask4 beside = (zeta >= outline->lowest()) & (zeta <= 1);
  if (!any(beside)) return p;
  const FourPoints from = p - centre(zeta);
  const Doubles4 x = dot(from, u), y = dot(from, v);
  const Doubles4 distance_m = hypotenuse(x / aspect, y * aspect);
  Doubles4 rho{};
  for (std::size_t lane = 0; lane < kDoubleLanes; ++lane)
    if (beside[lane]) rho[lane] = outline->rhoAt(zeta[lane]);
  const Doubles4 limit_m = radius(zeta, rho, a.length_m) + gap_m;
  constexpr double kRounding_m = 4e-3;
  const Doubles4 grow = smoothMax(distance_m, limit_m, kRounding_m) / distance_m - 1;
  return where(beside & (distance_m >= 1e-6), p + grow * x * u + grow * y * v, p);
}

}  // namespace echocine::heart
