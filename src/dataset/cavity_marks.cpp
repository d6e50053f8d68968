#include "dataset/cavity_marks.h"

#include <algorithm>
#include <cmath>

#include "motion/views/heart_marks.h"
#include "scene/role.h"

namespace echocine::dataset {

CavityMarks marksOf(const heart::Recording& recording, double phase) {
  const auto away = [&](double p) {
    return std::min(std::abs(p - phase), 1 - std::abs(p - phase));
  };
  const auto nearer = [&](double a, double b) { return away(a) < away(b); };
  const auto nearest = std::min_element(recording.phases.begin(), recording.phases.end(), nearer);
  const heart::Landmarks& places =
      recording.places[static_cast<std::size_t>(nearest - recording.phases.begin())];
  CavityMarks marks;
  marks.apex = places.apex;
  marks.mitral = places.mitral;
  return marks;
}

CavityMarks marksOf(const Scene& scene, const MeshMotion& motion, double phase) {
  SurfaceFrame surfaces;
  motion.frameAt(phase, surfaces, false);
  std::vector<RoleSurface> parts;
  for (std::size_t s = 0; s < scene.structures.size(); ++s) {
    const Role role = roleOf(scene.structures[s]);
    if (role == Role::none || role == Role::surroundings) continue;
    RoleSurface part{role, scene.structures[s].name, {}, motion.surfaces()[s].triangles};
    for (const Vec3f p : surfaces.positions_m[s])
      part.points_m.push_back(scene.probe.pose.toWorld(toDouble(p)));
    parts.push_back(std::move(part));
  }
  const HeartFrame frame = findHeart(parts, {}).frame;
  return {frame.apex, frame.mitral, frame.lateral, frame.anterior};
}

}  // namespace echocine::dataset
