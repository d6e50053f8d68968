#include "motion/heart/coarse_surfaces.h"

#include "core/check.h"
#include "motion/subdivision/shared_subdivision.h"

namespace echocine::heart {

Recording coarseSurfaces(Recording recording) {
  CHECK_EQ(recording.levels, Recording::kLevels);
  std::vector<Vec3f> control, refined;
  for (RecordedPart& part : recording.parts) {
    const auto vertices = static_cast<std::uint32_t>(part.control_m.front().size());
    const auto subdivision =
        sharedSubdivision(part.faces, vertices, part.tags, Recording::kLevels, {});
    refined.resize(subdivision->vertexCount());
    for (std::vector<Vec3d>& points : part.control_m) {
      control.clear();
      for (const Vec3d& p : points) control.push_back(toFloat(p));
      subdivision->apply(control, refined);
      for (std::size_t v = 0; v < points.size(); ++v)
        points[v] = 0.5 * (points[v] + toDouble(refined[v]));
    }
    part.volume_m3.clear();
  }
  recording.levels = 0;
  return recording;
}

}  // namespace echocine::heart
