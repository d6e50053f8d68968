#include "truth/view_offset.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "motion/surfaces/end_diastole.h"
#include "motion/surfaces/rest_marks.h"
#include "scene/names.h"
#include "scene/view_names.h"

namespace echocine {

namespace {

// Beyond these a plane is none of the standard ones. Our choices.
constexpr double kMostTilt_deg = 30, kMostTurn_deg = 30, kMostBeam_deg = 60;
// A distance from a standard plane that counts like kMostTurn_deg, in long axes. Our choice.
constexpr double kMostShift = 0.15;
constexpr Vec3d kNormal{0, 1, 0}, kBeam{0, 0, 1};  // of the imaging plane, in the probe frame

// Planes have no front: turns by half a circle are the same. In (-90, 90].
double planeTurn(double degrees) {
  const double turn = std::remainder(degrees, 180.0);
  return turn <= -90 ? turn + 180 : turn;
}

double angleBetween_deg(Vec3d a, Vec3d b) {
  return degreesFromRadians(std::atan2(length(cross(a, b)), dot(a, b)));
}

double betweenPlanes_deg(Vec3d a, Vec3d b) {
  const double angle_deg = angleBetween_deg(a, b);
  return std::min(angle_deg, 180 - angle_deg);
}

// The turn of a plane that holds the long axis, from lateral towards anterior.
double turnOf(const HeartFrame& heart, Vec3d normal) {
  return degreesFromRadians(std::atan2(-dot(normal, heart.lateral), dot(normal, heart.anterior)));
}

// From the ring's middle, as far as a plane shows the cavity.
double shownLength(Vec3d base_m, const SurfaceTopology& cavity, std::span<const Vec3f> p,
                   Vec3d on_m, Vec3d normal) {
  const Vec3d base_there_m = base_m - dot(base_m - on_m, normal) * normal;
  double longest_m = 0;
  for (const Triangle& t : cavity.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d from = toDouble(p[t[i]]), to = toDouble(p[t[(i + 1) % 3]]);
      const double a = dot(from - on_m, normal), b = dot(to - on_m, normal);
      if ((a >= 0) == (b >= 0)) continue;
      longest_m = std::max(longest_m, length(from + (a / (a - b)) * (to - from) - base_there_m));
    }
  return longest_m;
}

// Along the standard plane's normal, from its centre to the imaging plane; positive towards the
// apex.
double shiftAlong(const StandardPlane& plane, const HeartFrame& heart) {
  const Vec3d normal = dot(plane.normal, heart.apical) < 0 ? -plane.normal : plane.normal;
  return -plane.centre.y / normal.y;
}

// How much the imaging plane differs from a standard one: 1 for one limit of angle or distance. The
// beam of a short axis may come from any side. None if they differ too much to compare.
std::optional<double> differenceFrom(const StandardPlane& plane, const HeartFrame& heart) {
  const bool is_short =
      betweenPlanes_deg(heart.apical, kNormal) <= kMostTilt_deg ||
      (plane.short_axis && betweenPlanes_deg(plane.normal, kNormal) <= kMostTilt_deg);
  if (is_short != plane.short_axis) return std::nullopt;
  const double angle_deg = betweenPlanes_deg(plane.normal, kNormal);
  const double beam_deg = is_short ? 0 : angleBetween_deg(plane.axis, kBeam);
  if (beam_deg > kMostBeam_deg) return std::nullopt;
  const double shift_m = is_short ? shiftAlong(plane, heart) : plane.centre.y;
  return std::hypot(angle_deg / kMostTurn_deg, beam_deg / kMostBeam_deg,
                    shift_m / (kMostShift * heart.length_m));
}

ViewOffset offsetFrom(const StandardPlane& plane, const HeartFrame& heart) {
  ViewOffset view;
  if (plane.short_axis) {
    view.tilt_deg = betweenPlanes_deg(plane.normal, kNormal);
    view.shift_mm = millimetresFromMetres(shiftAlong(plane, heart));
    return view;
  }
  view.tilt_deg = degreesFromRadians(std::asin(std::clamp(heart.apical.y, -1.0, 1.0)));
  view.shift_mm = millimetresFromMetres(plane.centre.y);
  view.rotation_deg = planeTurn(turnOf(heart, kNormal) - turnOf(heart, plane.normal));
  return view;
}

}  // namespace

ViewOffset viewOffset(const HeartMarks& marks, const SurfaceTopology& cavity,
                      std::span<const Vec3f> positions_m) {
  const HeartFrame& heart = marks.frame;
  ViewOffset nearest;
  double least = 1e9;
  for (const ViewName& name : viewNames()) {
    if (name.view == View::psax_base && !marks.aortic_found) continue;
    const StandardPlane plane = standardPlane(name.view, heart);
    const std::optional<double> difference = differenceFrom(plane, heart);
    if (!difference || *difference >= least) continue;
    least = *difference;
    nearest = offsetFrom(plane, heart);
    nearest.label = name.key;
    if (plane.short_axis) continue;
    const auto shown = [&](Vec3d on_m, Vec3d normal) {
      return shownLength(heart.origin, cavity, positions_m, on_m, normal);
    };
    nearest.foreshortening_mm =
        millimetresFromMetres(shown(plane.centre, plane.normal) - shown({}, kNormal));
    if (std::abs(nearest.tilt_deg) > kMostTilt_deg ||
        std::abs(*nearest.rotation_deg) > kMostTurn_deg)
      nearest.label = "other";
  }
  return nearest;
}

std::optional<ViewOffset> viewOffset(const Scene& scene, const MeshMotion& motion) {
  const auto ventricle = ventricleOf(scene);
  const std::optional<RestMarks> rest = restMarks(scene, motion);
  if (!ventricle || !rest) return std::nullopt;
  SurfaceFrame surfaces;
  motion.frameAt(rest->phase, surfaces, false);
  return viewOffset(rest->heart, motion.surfaces()[index(*ventricle)],
                    surfaces.positions_m[index(*ventricle)]);
}

}  // namespace echocine
