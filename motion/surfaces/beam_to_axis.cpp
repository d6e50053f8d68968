#include "motion/surfaces/beam_to_axis.h"

#include <algorithm>

#include "motion/views/long_axis.h"
#include "scene/role.h"

namespace echocine {

// In the probe frame the probe's axis is z.
double squaredSineToLongAxis(const Scene& scene, const MeshMotion& motion) {
  const std::optional<SurfaceId> cavity = structureOf(scene, Role::lv_cavity);
  if (!cavity) return 0;
  SurfaceFrame frame;
  motion.positionsAt(0, {&*cavity, 1}, frame);
  const std::vector<Vec3f>& at_m = frame.positions_m[index(*cavity)];
  Facets facets;
  for (const Triangle& t : motion.surfaces()[index(*cavity)].triangles)
    facets.push_back({toDouble(at_m[t[0]]), toDouble(at_m[t[1]]), toDouble(at_m[t[2]])});
  if (facets.empty()) return 0;
  const double cosine = principalAxis(facets).z;
  return std::clamp(1 - cosine * cosine, 0.0, 1.0);
}

}  // namespace echocine
