#include "motion/keyframe_set.h"

#include "core/hash.h"
#include "motion/mesh/mesh_check.h"
#include "motion/mesh/mesh_io.h"
#include "motion/repair/mesh_repair.h"

namespace echocine {

KeyframeSet readKeyframes(const Scene& scene) {
  KeyframeSet set;
  Sha256 digest;
  for (const Structure& structure : scene.structures) {
    std::vector<KeyframeMesh> keyframes;
    for (const Keyframe& keyframe : structure.keyframes)
      keyframes.push_back(readKeyframe(keyframe, structure, digest));
    const std::string note = repairKeyframes(structure, keyframes);
    if (!note.empty()) set.repair_notes.push_back(note);
    checkKeyframes(structure, keyframes, scene.motion.mesh_unit_m);
    set.structures.push_back(std::move(keyframes));
  }
  set.sha256 = digest.hex();
  return set;
}

}  // namespace echocine
