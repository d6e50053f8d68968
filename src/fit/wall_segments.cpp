#include "core/error.h"
#include "fit/model_plane.h"
#include "motion/surfaces/interior_motion.h"
#include "truth/heart_function.h"

namespace echocine::fit {

std::optional<WallSegments> wallSegments(const Scene& scene, const MeshMotion& motion) {
  const auto cavity = structureOf(scene, Role::lv_cavity);
  if (!cavity || !structureOf(scene, Role::lv_wall)) return std::nullopt;
  WallSegments out{index(*cavity), {}};
  out.of_vertex.assign(motion.surfaces()[out.surface].vertex_count, 0);
  try {
    const MotionField field = interiorMotion(scene, motion);
    const HeartFunction function(scene, motion, field, 0);
    for (const WallColumn& column : function.columns())
      out.of_vertex[column.vertex] = static_cast<std::uint8_t>(column.segment);
  } catch (const SceneError&) {  // no wall round the cavity
    return std::nullopt;
  }
  return out;
}

}  // namespace echocine::fit
