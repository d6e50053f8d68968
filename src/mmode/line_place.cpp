#include "mmode/line_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"
#include "scene/names.h"
#include "scene/role.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// The tip of the valve's leaflets: the point of its contours farthest from the ring towards the
// apex.
std::optional<Vec3d> tipsOf(const FrameTruth& truth, const Scene& scene) {
  const FunctionFrame& function = *truth.function;
  const Vec3d ring = function.mitral->middle_m, down = function.axis.apex_m - ring;
  std::optional<Vec3d> tip;
  double farthest = 0;
  for (const Contour& contour : truth.contours) {
    if (roleOf(scene.structures[index(contour.surface)]) != Role::mitral_valve) continue;
    for (const Vec3d& point : contour.points_m) {
      const double along = dot(point - ring, down);
      if (along <= farthest) continue;
      farthest = along;
      tip = point;
    }
  }
  return tip;
}

// The hinge of `ring` farther from `other`, or the nearer one.
std::optional<Vec3d> hingeOf(const std::optional<RingFrame>& ring,
                             const std::optional<RingFrame>& other, bool farther) {
  if (!ring || !ring->hinges_m || !other) return {};
  const auto [left, right] = *ring->hinges_m;
  const bool left_is_farther = length(left - other->middle_m) > length(right - other->middle_m);
  return left_is_farther == farther ? left : right;
}

}  // namespace

void refuseWithoutRoles(const Scene& scene, MModeTarget target) {
  for (const Role role : {Role::lv_cavity, Role::lv_wall, Role::mitral_valve})
    if ((role != Role::mitral_valve || target == MModeTarget::mitral_tips) &&
        !structureOf(scene, role))
      throw SceneError(fmt::format("--through {}: no structure has the role {}; set role",
                                   nameOf(target), nameOf(role)));
}

std::optional<Vec3d> targetIn(const FrameTruth& truth, const Scene& scene, MModeTarget target) {
  if (!truth.function) return {};
  const FunctionFrame& function = *truth.function;
  const std::optional<RingFrame>& other = function.tricuspid ? function.tricuspid : function.aortic;
  switch (target) {
    case MModeTarget::mitral_tips:
      return function.mitral ? tipsOf(truth, scene) : std::nullopt;
    case MModeTarget::mitral_lateral:
      return hingeOf(function.mitral, other, true);
    case MModeTarget::mitral_septal:
      return hingeOf(function.mitral, other, false);
    case MModeTarget::tricuspid_lateral:
      return hingeOf(function.tricuspid, function.mitral, true);
    case MModeTarget::aortic_valve:
      if (!function.aortic || !function.aortic->hinges_m) return {};
      return 0.5 * (function.aortic->hinges_m->first + function.aortic->hinges_m->second);
  }
  return {};
}

std::optional<double> placeGiven(const Probe& probe, std::optional<double> angle_deg,
                                 std::optional<double> offset_mm) {
  if (angle_deg && !probe.isFan())
    throw SceneError("--angle: the lines of a linear probe are parallel; use --offset");
  if (offset_mm && probe.isFan())
    throw SceneError("--offset: the lines of this probe form a fan; use --angle");
  if (angle_deg) return radiansFromDegrees(*angle_deg);
  if (offset_mm) return metresFromMillimetres(*offset_mm);
  return {};
}

int lineAt(const Probe& probe, double place, const char* option) {
  const ScanGeometry geometry(probe);
  if (probe.lines > 1) {
    const double line = (place - geometry.firstPlace()) / geometry.cellWidth();
    if (geometry.fullTurn() && std::isfinite(place))
      return geometry.nearestLine(std::remainder(line, probe.lines));
    if (line >= -0.5 && line <= probe.lines - 0.5) return geometry.nearestLine(line);
  } else if (place >= geometry.firstPlace() && place <= geometry.lastPlace()) {
    return 0;
  }
  const auto shown = [&](double at) {
    return geometry.angular() ? degreesFromRadians(at) : millimetresFromMetres(at);
  };
  throw SceneError(fmt::format("{}: {:g} is outside the sector, accepted: {:g} to {:g} {}", option,
                               shown(place), shown(geometry.firstPlace()),
                               shown(geometry.lastPlace()), geometry.angular() ? "degrees" : "mm"));
}

int lineThrough(const Probe& probe, Vec3d point_m, MModeTarget target) {
  const ScanGeometry geometry(probe);
  if (const auto at = geometry.beamPosition(point_m.x, point_m.z))
    if (at->path_m >= probe.min_depth_m && at->path_m <= probe.max_depth_m)
      return geometry.nearestLine(at->line);
  throw SceneError(fmt::format(
      "--through {}: is outside the sector, {:.1f} mm lateral of the apex and {:.1f} mm deep",
      nameOf(target), millimetresFromMetres(point_m.x), millimetresFromMetres(point_m.z)));
}

}  // namespace echocine
