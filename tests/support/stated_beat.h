#pragma once
// A stated beat for hearts whose meshes do not move. It keeps the volume of the muscle, as real
// hearts nearly do: cavities empty, walls thicken, the base descends, the apex and the roofs of
// the atria stay in place.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "core/units.h"
#include "motion/mesh/mesh_io.h"
#include "support/real_hearts.h"

namespace echocine::support {

struct BeatStated {
  double ef = 0.55, rv_ef = 0.5;  // by the map; the meshes' own fractions are measured
  double shortening = 0.13;       // of the distance from apex to mitral ring
  double twist_deg = 10;          // of the apex relative to the ring
};

// Surfaces of one instant, m: cavity of the left ventricle, and surfaces that may bound its muscle
// outside, such as the epicardium and the right ventricle's cavity.
struct LeftVentricle {
  Vec3d apex, mitral;
  TriangleMesh cavity;
  std::vector<TriangleMesh> outside;
};

// In cylindrical coordinates (r, angle, z) about the long axis, z from the apex to the ring at L,
// with the part s of systole and lambda = 1 - shortening * s:
//   z' = lambda z,   r'^2 = (r^2 - s A(r)) / lambda,
//   A = ef * min(r, e)^2 + rv_ef * max(0, r^2 - o^2),
// where e and o are the radii of endocardium and outer border in that direction. Between e and o
// the map keeps volumes; inside e it scales them by 1 - ef s, beyond o by 1 - rv_ef s. Twist adds
// to the angle. From 0.8 L upwards, emptying fades to a quarter at the ring and to nothing 15 mm
// above it.
class StatedBeat {
 public:
  StatedBeat(const LeftVentricle& heart, const BeatStated& stated)
      : stated_(stated),
        apex_(heart.apex),
        axis_(normalised(heart.mitral - heart.apex)),
        length_m_(length(heart.mitral - heart.apex)) {
    const Vec3d other = std::abs(axis_.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    x_ = normalised(cross(other, axis_));
    y_ = cross(axis_, x_);
    for (int row = 0; row < kRows; ++row)
      for (int column = 0; column < kColumns; ++column) {
        const Vec3d from = apex_ + heightOf(row) * axis_;
        const double angle = 2 * std::numbers::pi * column / kColumns;
        const Vec3d way = std::cos(angle) * x_ + std::sin(angle) * y_;
        // The first crossings. Above the cavity there are none.
        const double inner = firstCrossing(heart.cavity, from, way, 0).value_or(0);
        double outer = kFar_m;
        for (const TriangleMesh& mesh : heart.outside)
          outer = std::min(outer,
                           firstCrossing(mesh, from, way, inner + kLeastWall_m).value_or(kFar_m));
        inner_[row][column] = inner;
        outer_[row][column] = outer == kFar_m && row > 0 ? outer_[row - 1][column] : outer;
      }
    smooth(inner_);
    smooth(outer_);
  }

  // Where a point of end-diastole is when the part `s` of systole has passed, 0 to 1. `roof_m`:
  // height above the ring where nothing moves.
  Vec3d moved(Vec3d point, double s, double roof_m) const {
    const Vec3d from = point - apex_;
    const double z = dot(from, axis_), x = dot(from, x_), y = dot(from, y_);
    const double r = std::hypot(x, y), angle = std::atan2(y, x);
    const double above = std::clamp((z - length_m_) / roof_m, 0.0, 1.0);
    const double shorter = stated_.shortening * s;
    const double z_now = z <= length_m_ ? (1 - shorter) * z : z - shorter * length_m_ * (1 - above);
    const double fade = fadeAt(z);
    const double e = at(inner_, z, angle), o = std::max(e, at(outer_, z, angle));
    const double emptied =
        fade * (stated_.ef * square(std::min(r, e)) +
                stated_.rv_ef * std::max(0.0, square(std::min(r, o + kRightHeart_m)) - square(o)));
    const double wider = 1 + fade * (1 / (1 - shorter) - 1);
    const double r_now = std::sqrt(std::max(0.0, (r * r - s * emptied) * wider));
    const double turned =
        angle + s * radiansFromDegrees(stated_.twist_deg) * std::clamp(1 - z / length_m_, 0.0, 1.0);
    return apex_ + z_now * axis_ + r_now * (std::cos(turned) * x_ + std::sin(turned) * y_);
  }

 private:
  static constexpr int kRows = 28, kColumns = 48, kSmoothings = 2;
  static constexpr double kFar_m = 1, kLeastWall_m = 2e-3, kRightHeart_m = 45e-3;
  using Radii = std::array<std::array<double, kColumns>, kRows>;

  static double square(double v) { return v * v; }
  double heightOf(int row) const { return length_m_ * 1.1 * row / (kRows - 1); }

  double fadeAt(double z) const {
    constexpr double kAbove_m = 15e-3;
    if (z < 0.8 * length_m_) return 1;
    if (z < length_m_) return 1 - 0.75 * (z - 0.8 * length_m_) / (0.2 * length_m_);
    return 0.25 * std::clamp(1 - (z - length_m_) / kAbove_m, 0.0, 1.0);
  }

  // Bilinear in height and angle.
  double at(const Radii& radii, double z, double angle) const {
    const double row = std::clamp(z / heightOf(1), 0.0, static_cast<double>(kRows - 1));
    const double turns = angle / (2 * std::numbers::pi);
    const double column = (turns - std::floor(turns)) * kColumns;
    const int r = std::min(static_cast<int>(row), kRows - 2),
              c = std::min(static_cast<int>(column), kColumns - 1), d = (c + 1) % kColumns;
    const double v = row - r, u = column - c;
    return (1 - v) * ((1 - u) * radii[r][c] + u * radii[r][d]) +
           v * ((1 - u) * radii[r + 1][c] + u * radii[r + 1][d]);
  }

  static void smooth(Radii& radii) {
    for (int pass = 0; pass < kSmoothings; ++pass) {
      const Radii before = radii;
      for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
          const auto& middle = before[row];
          const auto& below = before[std::max(0, row - 1)];
          const auto& over = before[std::min(kRows - 1, row + 1)];
          radii[row][column] =
              0.25 * (2 * middle[column] + below[column] + over[column]) * 0.5 +
              0.25 * (middle[(column + 1) % kColumns] + middle[(column + kColumns - 1) % kColumns]);
        }
    }
  }

  // The nearest crossing beyond `least` of a ray with a mesh.
  static std::optional<double> firstCrossing(const TriangleMesh& mesh, Vec3d from, Vec3d way,
                                             double least) {
    std::optional<double> found;
    for (const Triangle& t : mesh.triangles) {
      const Vec3d a = mesh.positions[t[0]], e1 = mesh.positions[t[1]] - a,
                  e2 = mesh.positions[t[2]] - a, p = cross(way, e2);
      const double determinant = dot(e1, p);
      if (determinant == 0) continue;
      const Vec3d s = from - a, q = cross(s, e1);
      const double u = dot(s, p) / determinant, v = dot(way, q) / determinant,
                   distance = dot(e2, q) / determinant;
      if (u < 0 || v < 0 || u + v > 1 || distance < least) continue;
      if (!found || distance < *found) found = distance;
    }
    return found;
  }

  BeatStated stated_;
  Vec3d apex_, axis_, x_, y_;
  double length_m_;
  Radii inner_{}, outer_{};
};

}  // namespace echocine::support
