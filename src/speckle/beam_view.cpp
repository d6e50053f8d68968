#include "speckle/beam_view.h"

#include <algorithm>
#include <cmath>

#include "scene/beam_profile.h"

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
  diffraction_ = followedWidth(1, spread.aperture_m, spread.wavelength_m);
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

Extent extentOf(const CubeCorners& corners, double margin_m) {
  Vec3f low = corners[0], high = corners[0];
  for (const Vec3f c : corners) {
    low = {std::min(low.x, c.x), std::min(low.y, c.y), std::min(low.z, c.z)};
    high = {std::max(high.x, c.x), std::max(high.y, c.y), std::max(high.z, c.z)};
  }
  const Vec3d middle = toDouble(0.5f * (low + high)), half = toDouble(0.5f * (high - low));
  return {middle.x, middle.z, std::sqrt(half.x * half.x + half.z * half.z) + margin_m,
          middle.y - half.y - margin_m, middle.y + half.y + margin_m};
}

// Square of the distance from the plane at which the elevation is cut: a parabola over depth.
double BeamView::cutSquared(double path_m) const {
  const double d = diffraction_ * path_m, c = spread_.aperture_m * (1 - path_m / spread_.focus_m);
  return 0.5 * kElevationCut * kElevationCut * (d * d + c * c);
}

bool BeamView::sees(const Extent& e) const {
  const double r = std::sqrt(e.x_m * e.x_m + e.z_m * e.z_m);
  const double path_m =
      linear_ ? e.z_m * static_cast<double>(per_cosine_) : r - probe_.face_radius_m;
  const double reach_m = linear_ ? e.radius_m * static_cast<double>(per_cosine_) : e.radius_m;
  const double near_m = std::max(path_m - reach_m, 0.0), far_m = path_m + reach_m;
  if (far_m < probe_.min_depth_m || near_m > probe_.max_depth_m) return false;
  const double nearest_y_m = std::max({e.low_y_m, -e.high_y_m, 0.0});
  if (nearest_y_m * nearest_y_m > std::max(cutSquared(near_m), cutSquared(far_m))) return false;
  const double low = static_cast<double>(first_) - 0.5 * pitch_, high = low + pitch_ * probe_.lines;
  if (linear_) {
    const double at_m = e.x_m - e.z_m * static_cast<double>(tangent_);
    return at_m + reach_m >= low && at_m - reach_m <= high;
  }
  if (r <= e.radius_m) return true;
  // The disc's half angle: asin q <= q / sqrt(1 - q^2).
  const double q = e.radius_m / r, half = q / std::sqrt(1 - q * q) + 1e-4;
  const double at = e.z_m > 0 ? roughAngle(e.x_m, e.z_m) : std::atan2(e.x_m, e.z_m);
  return at + half >= low && at - half <= high;
}

}  // namespace echocine
