#include "truth/view_offset.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/units.h"
#include "truth/surface_normals.h"

namespace echocine {

namespace {

// Beyond these a plane is none of the standard ones. Our choices.
constexpr double kMostTilt_deg = 30, kMostTurn_deg = 30;
constexpr double kApical = 0.7;  // cosine between the beam's axis and the long axis

// Planes have no front: turns by half a circle are the same. In (-90, 90].
double planeTurn(double degrees) {
  const double turn = std::remainder(degrees, 180.0);
  return turn <= -90 ? turn + 180 : turn;
}

// Angle of a direction across the axis, from the four-chamber plane.
class Turns {
 public:
  explicit Turns(const ViewLandmarks& marks) {
    const HeartAxes& a = marks.axes;
    Vec3d septal = a.septal;
    if (marks.tricuspid_m)
      if (const Vec3d s = acrossAxis(*marks.tricuspid_m - a.base_m, a.axis); length(s) > 0)
        septal = normalised(s);
    lateral_ = -septal;
    anterior_ = cross(septal, a.axis);
  }
  double of(Vec3d direction) const {
    return planeTurn(
        degreesFromRadians(std::atan2(dot(direction, anterior_), dot(direction, lateral_))));
  }

 private:
  Vec3d lateral_, anterior_;
};

// From the ring's middle, as far as the plane shows the cavity.
double shownLength(Vec3d base_m, const SurfaceTopology& cavity, std::span<const Vec3f> p) {
  double longest_m = 0;
  for (const Triangle& t : cavity.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d a = toDouble(p[t[i]]), b = toDouble(p[t[(i + 1) % 3]]);
      if ((a.y >= 0) == (b.y >= 0)) continue;
      const Vec3d cut = a + (a.y / (a.y - b.y)) * (b - a);
      longest_m = std::max(longest_m, std::hypot(cut.x - base_m.x, cut.z - base_m.z));
    }
  return longest_m;
}

ViewOffset shortAxis(const HeartAxes& axes, double tilt_deg) {
  static constexpr const char* kLevels[] = {"psax-base", "psax-mid", "psax-apex"};
  ViewOffset view;
  view.tilt_deg = tilt_deg;
  const double zeta = -axes.base_m.y / (axes.axis.y * axes.length_m);
  const int third = std::clamp(static_cast<int>(std::floor(3 * zeta)), 0, 2);
  view.label = kLevels[third];
  view.shift_mm = millimetresFromMetres((zeta - (third + 0.5) / 3) * axes.length_m);
  return view;
}

}  // namespace

ViewOffset viewOffset(const ViewLandmarks& marks, const SurfaceTopology& cavity,
                      std::span<const Vec3f> positions_m) {
  const HeartAxes& axes = marks.axes;
  const double out_deg = degreesFromRadians(std::asin(std::clamp(axes.axis.y, -1.0, 1.0)));
  if (90 - std::abs(out_deg) <= kMostTilt_deg) return shortAxis(axes, 90 - std::abs(out_deg));
  ViewOffset view;
  view.tilt_deg = out_deg;
  view.shift_mm = millimetresFromMetres(axes.base_m.y + 0.5 * axes.length_m * axes.axis.y);
  view.foreshortening_mm =
      millimetresFromMetres(axes.length_m - shownLength(axes.base_m, cavity, positions_m));
  const Turns turns(marks);
  const double turn_deg = turns.of(cross(Vec3d{0, 1, 0}, axes.axis));
  double aortic_deg = -60;
  if (marks.aortic_m) aortic_deg = turns.of(acrossAxis(*marks.aortic_m - axes.base_m, axes.axis));
  const bool apical = -axes.axis.z > kApical;  // the beam enters at the apex
  struct Standard {
    double turn_deg;
    const char* from_apex;
    const char* from_side;
  };
  const Standard standards[] = {
      {0, "a4c", "subcostal"}, {60, "a2c", "other"}, {aortic_deg, "a3c", "plax"}};
  double nearest_deg = 360;
  for (const Standard& s : standards) {
    const double off_deg = planeTurn(turn_deg - s.turn_deg);
    if (std::abs(off_deg) >= std::abs(nearest_deg)) continue;
    nearest_deg = off_deg;
    view.label = apical ? s.from_apex : s.from_side;
  }
  view.rotation_deg = nearest_deg;
  if (std::abs(out_deg) > kMostTilt_deg || std::abs(nearest_deg) > kMostTurn_deg)
    view.label = "other";
  return view;
}

}  // namespace echocine
