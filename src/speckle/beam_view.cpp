#include "speckle/beam_view.h"

#include <algorithm>
#include <cmath>

namespace echocine {

BeamView::BeamView(const Probe& probe, const PointSpread& spread)
    : probe_(probe), spread_(spread), linear_(probe.kind == ProbeKind::linear) {
  const double lines = std::max(probe.lines - 1, 1);
  const double span = linear_ ? probe.last_offset_m - probe.first_offset_m
                              : probe.last_angle_rad - probe.first_angle_rad;
  double first = linear_ ? probe.first_offset_m : probe.first_angle_rad;
  pitch_ = span / lines;
  if (probe.lines == 1) {  // a line alone takes in what lies within a deviation's width
    first += 0.5 * span;
    pitch_ = spread.angle_rad * (linear_ ? probe.middleDepth() : 1);
  }
  widest_m_ =
      kElevationCut * std::max(spread.elevationWidth(0), spread.elevationWidth(probe.max_depth_m));
  first_ = static_cast<float>(first);
  per_pitch_ = static_cast<float>(1 / pitch_);
  face_radius_m_ = static_cast<float>(probe.face_radius_m);
  tangent_ = static_cast<float>(std::tan(probe.first_angle_rad));
  per_cosine_ = static_cast<float>(1 / std::cos(probe.first_angle_rad));
}

double BeamView::lateralLines(double path_m) const {
  const double at_m = linear_ ? 1 : probe_.face_radius_m + path_m;
  return at_m > 0 ? spread_.angle_rad * path_m / (pitch_ * at_m) : 0;
}

Ball ballAbout(const CubeCorners& corners, double margin_m) {
  Vec3f low = corners[0], high = corners[0];
  for (const Vec3f c : corners) {
    low = {std::min(low.x, c.x), std::min(low.y, c.y), std::min(low.z, c.z)};
    high = {std::max(high.x, c.x), std::max(high.y, c.y), std::max(high.z, c.z)};
  }
  return {toDouble(0.5f * (low + high)), 0.5 * length(toDouble(high - low)) + margin_m};
}

bool BeamView::sees(const Ball& ball) const {
  const Vec3d p = ball.centre_m;
  const double radius_m = ball.radius_m;
  if (std::abs(p.y) - radius_m > widest_m_) return false;
  const double r = std::hypot(p.x, p.z);
  const double path_m = linear_ ? p.z * static_cast<double>(per_cosine_) : r - probe_.face_radius_m;
  const double reach_m = linear_ ? radius_m * static_cast<double>(per_cosine_) : radius_m;
  const double near_m = path_m - reach_m, far_m = path_m + reach_m;
  if (far_m < probe_.min_depth_m || near_m > probe_.max_depth_m) return false;
  // w_e^2 is a parabola over depth, so it is largest at an end.
  const double widest_m =
      std::max(spread_.elevationWidth(std::max(near_m, 0.0)), spread_.elevationWidth(far_m));
  if (std::abs(p.y) - radius_m > kElevationCut * widest_m) return false;
  const double half = linear_ ? reach_m : r > radius_m ? std::asin(radius_m / r) : 4.0;
  const double at = linear_ ? p.x - p.z * static_cast<double>(tangent_) : std::atan2(p.x, p.z);
  const double low = static_cast<double>(first_) - 0.5 * pitch_;
  return at + half >= low && at - half <= low + pitch_ * std::max(probe_.lines, 1);
}

}  // namespace echocine
