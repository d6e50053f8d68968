#include "motion/surfaces/rest_marks.h"

#include "core/error.h"
#include "motion/mesh/surface_measure.h"
#include "motion/surfaces/end_diastole.h"
#include "scene/role.h"

namespace echocine {

std::optional<RestMarks> restMarks(const Scene& scene, const MeshMotion& motion) {
  const auto ventricle = ventricleOf(scene);
  if (!ventricle) return std::nullopt;
  const ControlMotion& control = motion.control(*ventricle);
  RestMarks rest;
  rest.phase =
      control.weights.phases()[largestKeyframe(control.weights.keyframeCount(), [&](std::size_t k) {
        return enclosedVolume(control.triangles, control.rows_m[k]);
      })];
  std::vector<RoleSurface> surfaces;
  for (std::size_t s = 0; s < scene.structures.size(); ++s) {
    const Role role = roleOf(scene.structures[s]);
    if (role == Role::none || role == Role::surroundings) continue;
    const ControlMotion& part = motion.control(static_cast<SurfaceId>(s));
    RoleSurface surface{role, scene.structures[s].name, {}, part.triangles};
    for (const Vec3f p : part.rows_m[nearestKeyframe(rest.phase, part.weights.phases())])
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
