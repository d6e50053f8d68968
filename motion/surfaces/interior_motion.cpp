#include "motion/surfaces/interior_motion.h"

#include <map>
#include <utility>
#include <vector>

#include "core/parallel.h"

namespace echocine {

namespace {

// A keyframe of a surface.
struct Shown {
  std::size_t surface, keyframe;
};

}  // namespace

// Structures mostly share their phases, so every phase is made once.
MotionField interiorMotion(const Scene& scene, const MeshMotion& motion) {
  std::vector<InteriorSurface> surfaces;
  std::map<double, std::vector<Shown>> at_phase;
  for (const SurfaceTopology& topology : motion.surfaces()) {
    const Structure& structure = scene.structures[index(topology.id)];
    const KeyframeWeights& weights = motion.control(topology.id).weights;
    const std::span<const double> phases = weights.phases();
    for (std::size_t k = 0; k < phases.size(); ++k)
      at_phase[phases[k]].push_back({surfaces.size(), k});
    surfaces.push_back({structure.name, topology.triangles, weights,
                        std::vector<std::vector<Vec3f>>(phases.size()), topology.membrane,
                        structure.priority});
  }
  const std::vector<std::pair<double, std::vector<Shown>>> wanted(at_phase.begin(), at_phase.end());
  constexpr std::size_t kTogether = 4;  // share a frame, in which still surfaces stay. Our choice
  parallelBlocks(wanted.size(), kTogether, [&](std::size_t begin, std::size_t end) {
    SurfaceFrame frame;
    for (std::size_t i = begin; i < end; ++i) {
      motion.frameAt(wanted[i].first, frame, false);
      for (const Shown& shown : wanted[i].second)
        surfaces[shown.surface].keyframes_m[shown.keyframe] = frame.positions_m[shown.surface];
    }
  });
  return MotionField(std::move(surfaces), {.cells = scene.accuracy.motion_field_cells,
                                           .beyond_m = scene.trabeculae.most_m()});
}

const std::shared_ptr<const MotionField>& SharedMotionField::shared() const {
  std::call_once(once_, [this] {
    if (!field_) field_ = std::make_shared<const MotionField>(interiorMotion(scene_, motion_));
  });
  return field_;
}

}  // namespace echocine
