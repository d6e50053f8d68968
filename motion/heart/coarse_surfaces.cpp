#include "motion/heart/coarse_surfaces.h"

#include "core/check.h"
#include "motion/heart/refined_part.h"

namespace echocine::heart {

Recording coarseSurfaces(Recording recording) {
  CHECK_EQ(recording.levels, Recording::kLevels);
  for (RecordedPart& part : recording.parts) {
    RefinedPart refined(part);
    for (std::size_t k = 0; k < part.control_m.size(); ++k) {
      const std::vector<Vec3f>& moved_m = refined.pointsAt(k);
      for (std::size_t v = 0; v < part.control_m[k].size(); ++v)
        part.control_m[k][v] = 0.5 * (part.control_m[k][v] + toDouble(moved_m[v]));
    }
    part.volume_m3.clear();
  }
  recording.levels = 0;
  return recording;
}

}  // namespace echocine::heart
