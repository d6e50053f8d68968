#include "examples/beating_heart/chamber.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace echocine::beating_heart {
namespace {

constexpr int kMeridianSteps = 256;

// Distance from the origin to the superellipse |a|^n + |r|^n = 1 in the direction (cos, sin) of an
// angle.
double superellipse(double angle_rad, double exponent) {
  const double a = std::pow(std::abs(std::cos(angle_rad)), exponent);
  const double r = std::pow(std::abs(std::sin(angle_rad)), exponent);
  return std::pow(a + r, -1 / exponent);
}

double smoothMax(double a, double b) {
  constexpr double kRounding_cm = 0.25;
  return 0.5 * (a + b + std::hypot(a - b, kRounding_cm));
}

}  // namespace

ChamberSurface::ChamberSurface(const Chamber& chamber) : chamber_(chamber) {
  axis_ = normalised(chamber.ring_cm - chamber.apex_cm);
  side_ = cross(up_, axis_);
  const double to_ring_cm = length(chamber.ring_cm - chamber.apex_cm);
  const double length_cm = to_ring_cm + chamber.beyond_ring_cm;
  to_apex_cm_ = chamber.widest * length_cm;
  to_cap_cm_ = length_cm - to_apex_cm_;
  centre_ = chamber.apex_cm + to_apex_cm_ * axis_;
  const double ring = (to_ring_cm - to_apex_cm_) / to_cap_cm_;
  taper_ = (1 - chamber.ring_radius_cm / radiusAt(ring * to_cap_cm_)) / (ring * ring);

  // Sampled finely by angle, then resampled by arc length so that no triangle is starved at the
  // cap.
  std::vector<Meridian> fine(4 * kMeridianSteps + 1);
  std::vector<double> arc_cm(fine.size(), 0);
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const double angle_rad = std::numbers::pi * double(i) / double(fine.size() - 1);
    const bool valve_half = 2 * i >= fine.size();
    const double rho =
        superellipse(angle_rad, valve_half ? chamber.cap_exponent : chamber.apex_exponent);
    const double along = -rho * std::cos(angle_rad);
    const double narrowing = valve_half ? 1 - taper_ * along * along : 1;
    fine[i] = {along * (valve_half ? to_cap_cm_ : to_apex_cm_),
               chamber.radius_cm * rho * std::abs(std::sin(angle_rad)) * narrowing};
    if (i > 0)
      arc_cm[i] = arc_cm[i - 1] + std::hypot(fine[i].along - fine[i - 1].along,
                                             fine[i].radius - fine[i - 1].radius);
  }
  fine.front().radius = fine.back().radius = 0;
  for (int step = 0; step <= kMeridianSteps; ++step) {
    const double want_cm = arc_cm.back() * step / kMeridianSteps;
    const auto above = std::upper_bound(arc_cm.begin() + 1, arc_cm.end() - 1, want_cm);
    const auto i = static_cast<std::size_t>(above - arc_cm.begin());
    const double t = (want_cm - arc_cm[i - 1]) / (arc_cm[i] - arc_cm[i - 1]);
    meridian_.push_back({std::lerp(fine[i - 1].along, fine[i].along, t),
                         std::lerp(fine[i - 1].radius, fine[i].radius, t)});
  }
}

double ChamberSurface::radiusAt(double along_cm) const {
  const bool valve_half = along_cm > 0;
  const double share = std::abs(along_cm) / (valve_half ? to_cap_cm_ : to_apex_cm_);
  if (share >= 1) return 0;
  const double exponent = valve_half ? chamber_.cap_exponent : chamber_.apex_exponent;
  const double narrowing = valve_half ? 1 - taper_ * share * share : 1;
  return chamber_.radius_cm * narrowing * std::pow(1 - std::pow(share, exponent), 1 / exponent);
}

double ChamberSurface::bowAt(double along_cm) const {
  const double share =
      std::min(1.0, std::abs(along_cm) / (along_cm > 0 ? to_cap_cm_ : to_apex_cm_));
  return chamber_.bow_cm * (1 - share * share);
}

Vec3d ChamberSurface::at(Vec3d direction) const {
  const double polar = std::acos(std::clamp(-direction.z, -1.0, 1.0)) / std::numbers::pi;
  const double step = polar * kMeridianSteps;
  const int i = std::min(static_cast<int>(step), kMeridianSteps - 1);
  const double along = std::lerp(meridian_[i].along, meridian_[i + 1].along, step - i);
  const double radius = std::lerp(meridian_[i].radius, meridian_[i + 1].radius, step - i);
  // Turned by an odd angle, so that no edge of the icosahedron lies in the imaging plane.
  constexpr double kTurn_rad = 0.3;
  const double azimuth_rad =
      std::atan2(direction.y, direction.x) + kTurn_rad + chamber_.twist_rad * (1 - polar);
  const double y = chamber_.aspect * radius * std::sin(azimuth_rad);
  const double x = bowAt(along) + chamber_.wrap_per_cm * y * y + radius * std::cos(azimuth_rad);
  return centre_ + along * axis_ + x * side_ + y * up_;
}

Vec3d ChamberSurface::pushedOut(Vec3d point, double depth_cm) const {
  const Vec3d from_centre = point - centre_;
  const double along = dot(from_centre, axis_);
  const double x = dot(from_centre, side_) - bowAt(along);
  const double y = dot(from_centre, up_) / chamber_.aspect;
  const double distance = std::hypot(x, y);
  const double limit = radiusAt(along) - depth_cm;
  if (limit <= 0) return point;
  const double grow = smoothMax(distance, limit) / distance - 1;
  return point + grow * x * side_ + grow * y * chamber_.aspect * up_;
}

std::vector<Vec3d> pointsOf(const ChamberSurface& surface, const SphereMesh& sphere) {
  std::vector<Vec3d> points;
  points.reserve(sphere.directions.size());
  for (const Vec3d direction : sphere.directions) points.push_back(surface.at(direction));
  return points;
}

}  // namespace echocine::beating_heart
