#include "speckle/beam_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/rough_angle.h"
#include "scene/beam_profile.h"
#include "scene/scan_geometry.h"

namespace echocine {

BeamView::BeamView(const Probe& probe, const PointSpread& spread)
    : probe_(probe), spread_(spread), linear_(!probe.isFan()), full_turn_(probe.isFullTurn()) {
  const ScanGeometry geometry(probe);
  const double lines = std::max(probe.lines - 1, 1);
  double first = geometry.firstPlace();
  const double span = geometry.lastPlace() - first;
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
  samples_ = static_cast<float>(probe.samples);
  min_depth_m_ = static_cast<float>(probe.min_depth_m);
  per_spacing_ = static_cast<float>(1 / probe.sampleSpacing());
  across_ = static_cast<float>(std::sqrt(0.5) * kElevationCut * diffraction_);
  lens_ = static_cast<float>(std::sqrt(0.5) * kElevationCut * spread.aperture_m);
  per_focus_ = static_cast<float>(1 / spread.focus_m);
}

namespace {

Floats8 root(Floats8 a) {
  Floats8 out;
  for (std::size_t i = 0; i < kFloatLanes; ++i) out[i] = std::sqrt(a[i]);
  return out;
}

// atan2(x, z) for z >= 0, to 1e-5 rad; about +-pi / 2 behind the probe.
Floats8 angleOf(Floats8 x, Floats8 z) {
  const Floats8 ax = x < 0 ? -x : x, ahead = z > 0 ? z : Floats8{};
  const Floats8 large = ax > ahead ? ax : ahead, small = ax > ahead ? ahead : ax;
  const Floats8 q = small / (large + 1e-30f), q2 = q * q;
  const Floats8 near =  // roughArctangent() in single precision
      q *
      (0.9998660f + q2 * (-0.3302995f + q2 * (0.1801410f + q2 * (-0.0851330f + q2 * 0.0208351f))));
  const Floats8 angle = ax > ahead ? static_cast<float>(std::numbers::pi / 2) - near : near;
  return x < 0 ? -angle : angle;
}

// The same all round.
Floats8 angleAround(Floats8 x, Floats8 z) {
  const Floats8 ahead = angleOf(x, z < 0 ? -z : z);
  const float pi = static_cast<float>(std::numbers::pi);
  return z < 0 ? (x < 0 ? -pi - ahead : pi - ahead) : ahead;
}

// The bits that all lanes have.
std::int32_t shared(Ints8 bits) {
  bits &= __builtin_shufflevector(bits, bits, 4, 5, 6, 7, 0, 1, 2, 3);
  bits &= __builtin_shufflevector(bits, bits, 2, 3, 0, 1, 6, 7, 4, 5);
  return bits[0] & bits[1];
}

}  // namespace

BeamCube BeamView::cubeOf(const CubeCorners& c) const {
  const Floats8 x{c[0].x, c[1].x, c[2].x, c[3].x, c[4].x, c[5].x, c[6].x, c[7].x},
      y{c[0].y, c[1].y, c[2].y, c[3].y, c[4].y, c[5].y, c[6].y, c[7].y},
      z{c[0].z, c[1].z, c[2].z, c[3].z, c[4].z, c[5].z, c[6].z, c[7].z};
  Floats8 line, path_m;
  if (linear_) {
    line = (x - z * tangent_ - first_) * per_pitch_;
    path_m = z * per_cosine_;
  } else {
    line = ((full_turn_ ? angleAround(x, z) : angleOf(x, z)) - first_) * per_pitch_;
    if (full_turn_) {  // corners within half a turn of the first one
      const float turn = static_cast<float>(probe_.lines);
      line = line - line[0] > 0.5f * turn ? line - turn : line;
      line = line - line[0] < -0.5f * turn ? line + turn : line;
    }
    path_m = root(x * x + z * z) - face_radius_m_;
  }
  const Floats8 held = path_m > 1e-4f ? path_m : Floats8{} + 1e-4f;
  const Floats8 d = across_ * held, b = lens_ * (1 - held * per_focus_);
  return {line + 0.5f, (path_m - min_depth_m_) * per_spacing_, y / root(d * d + b * b)};
}

// Cohen and Sutherland's codes: one bit for each side that a corner lies beyond.
bool BeamView::sees(const BeamCube& c, LineRange lines) const {
  const auto first = static_cast<float>(lines.first), end = static_cast<float>(lines.end);
  Ints8 beyond = ((c.sample < 0) & 4) | ((c.sample >= samples_) & 8) | ((c.across < -1) & 16) |
                 ((c.across > 1) & 32);
  if (!full_turn_) beyond |= ((c.line < first) & 1) | ((c.line >= end) & 2);
  return shared(beyond) == 0;
}

double BeamView::lateralLines(double path_m) const {
  const double at_m = linear_ ? 1 : probe_.face_radius_m + path_m;
  return at_m > 0 ? spread_.angle(path_m) * path_m / (pitch_ * at_m) : 0;
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
  if (full_turn_ || r <= e.radius_m) return true;
  // The disc's half angle: asin q <= q / sqrt(1 - q^2).
  const double q = e.radius_m / r, half = q / std::sqrt(1 - q * q) + 1e-4;
  const double at = e.z_m > 0 ? roughAngle(e.x_m, e.z_m) : std::atan2(e.x_m, e.z_m);
  return at + half >= low && at - half <= high;
}

}  // namespace echocine
