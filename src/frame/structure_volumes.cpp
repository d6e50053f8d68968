#include "frame/structure_volumes.h"

#include <map>

#include "core/units.h"

namespace echocine {

Volumes structureVolumes(const Scene& scene, const MeshMotion& motion,
                         const SurfaceFrame& surfaces) {
  Volumes volumes;
  for (const SurfaceTopology& surface : motion.surfaces()) {
    if (surface.membrane) continue;
    volumes.emplace_back(scene.structures[index(surface.id)].name,
                         millilitresFromCubicMetres(motion.volumeIn(surfaces, surface)));
  }
  return volumes;
}

std::vector<KeyframeVolume> keyframeVolumes(const Scene& scene, const MeshMotion& motion) {
  std::vector<KeyframeVolume> list;
  std::map<double, Volumes> by_phase;  // structures mostly share their phases
  SurfaceFrame surfaces;
  for (const Structure& structure : scene.structures) {
    if (structure.membrane) continue;
    for (const Keyframe& keyframe : structure.keyframes) {
      Volumes& all = by_phase[keyframe.phase];
      if (all.empty()) {
        motion.frameAt(keyframe.phase, surfaces, false);
        all = structureVolumes(scene, motion, surfaces);
      }
      for (const auto& [name, ml] : all)
        if (name == structure.name) list.push_back({name, keyframe.phase, ml});
    }
  }
  return list;
}

}  // namespace echocine
