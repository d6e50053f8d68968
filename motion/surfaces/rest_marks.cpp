#include "motion/surfaces/rest_marks.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "motion/mesh/surface_measure.h"
#include "scene/role.h"

namespace echocine {

namespace {

// The keyframe of the largest volume; the first of several.
std::size_t largestOf(const ControlMotion& motion) {
  std::size_t largest = 0;
  double most = 0;
  for (std::size_t k = 0; k < motion.weights.keyframeCount(); ++k)
    if (const double volume = std::abs(enclosedVolume(motion.triangles, motion.rows_m[k]));
        volume > most) {
      most = volume;
      largest = k;
    }
  return largest;
}

std::size_t nearestTo(double phase, std::span<const double> phases) {
  std::size_t nearest = 0;
  const auto apart = [&](std::size_t k) { return std::abs(std::remainder(phases[k] - phase, 1)); };
  for (std::size_t k = 1; k < phases.size(); ++k)
    if (apart(k) < apart(nearest)) nearest = k;
  return nearest;
}

}  // namespace

std::optional<RestMarks> restMarks(const Scene& scene, const MeshMotion& motion) {
  auto ventricle = structureOf(scene, Role::lv_cavity);
  if (!ventricle) ventricle = structureOf(scene, Role::lv_wall);
  if (!ventricle) return std::nullopt;
  const ControlMotion& of_ventricle = motion.control(*ventricle);
  RestMarks rest;
  rest.phase = of_ventricle.weights.phases()[largestOf(of_ventricle)];
  std::vector<RoleSurface> surfaces;
  for (std::size_t s = 0; s < scene.structures.size(); ++s) {
    const Role role = roleOf(scene.structures[s]);
    if (role == Role::none || role == Role::surroundings) continue;
    const ControlMotion& control = motion.control(static_cast<SurfaceId>(s));
    RoleSurface surface{role, scene.structures[s].name, {}, control.triangles};
    for (const Vec3f p : control.rows_m[nearestTo(rest.phase, control.weights.phases())])
      surface.points_m.push_back(toDouble(p));
    surfaces.push_back(std::move(surface));
  }
  try {
    rest.heart = findHeart(surfaces, {});
  } catch (const SceneError&) {
    return std::nullopt;
  }
  return rest;
}

}  // namespace echocine
