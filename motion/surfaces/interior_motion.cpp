#include "motion/surfaces/interior_motion.h"

#include <map>

namespace echocine {

// Structures mostly share their phases, so every phase is made once.
MotionField interiorMotion(const Scene& scene, const MeshMotion& motion,
                           const FieldSettings& settings) {
  std::vector<InteriorSurface> surfaces;
  std::map<double, std::vector<std::size_t>> shown;  // phase -> surfaces with a keyframe there
  for (const SurfaceTopology& topology : motion.surfaces()) {
    const Structure& structure = scene.structures[index(topology.id)];
    const KeyframeWeights& weights = motion.control(topology.id).weights;
    for (const double phase : weights.phases()) shown[phase].push_back(surfaces.size());
    surfaces.push_back(
        {structure.name, topology.triangles, weights, {}, topology.membrane, structure.priority});
  }
  SurfaceFrame frame;
  for (const auto& [phase, which] : shown) {
    motion.frameAt(phase, frame);
    for (const std::size_t s : which) surfaces[s].keyframes_m.push_back(frame.positions_m[s]);
  }
  return MotionField(std::move(surfaces), settings);
}

const std::shared_ptr<const MotionField>& SharedMotionField::shared() const {
  std::call_once(once_, [this] {
    field_ = std::make_shared<const MotionField>(interiorMotion(scene_, motion_));
  });
  return field_;
}

}  // namespace echocine
