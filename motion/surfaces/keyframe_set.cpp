#include "motion/surfaces/keyframe_set.h"

#include <fmt/format.h>

#include <filesystem>

#include "core/error.h"
#include "core/hash.h"
#include "core/stop.h"
#include "motion/mesh/mesh_check.h"
#include "motion/mesh/mesh_io.h"
#include "motion/mesh/world_place.h"
#include "motion/repair/mesh_repair.h"
#include "motion/repair/repair_advice.h"

namespace echocine {

namespace {

// Runs before any file is read, which may take minutes: a missing file is usually a typing error.
void checkFilesAreThere(const Scene& scene) {
  std::string first;
  std::size_t missing = 0;
  for (const Structure& structure : scene.structures)
    for (const Keyframe& keyframe : structure.keyframes)
      for (std::size_t i = 0; i < keyframe.files.size(); ++i) {
        if (i < keyframe.meshes.size() && keyframe.meshes[i]) continue;
        std::error_code failed;
        if (std::filesystem::status(keyframe.files[i], failed).type() !=
            std::filesystem::file_type::not_found)
          continue;
        if (missing++ == 0)
          first = atPlace(structure.place,
                          fmt::format("{}: {}: cannot be opened: No such file or directory",
                                      structure.name, keyframe.files[i].string()));
      }
  if (missing > 1)
    first += fmt::format("; {} more file{} missing", missing - 1, missing > 2 ? "s are" : " is");
  if (missing > 0) throw SceneError(first);
}

std::vector<KeyframeMesh> soundKeyframes(const Structure& structure, double mesh_unit_m,
                                         Sha256& digest, KeyframeSet& set) {
  std::vector<KeyframeMesh> keyframes;
  for (const Keyframe& keyframe : structure.keyframes) {
    checkpoint();
    keyframes.push_back(readKeyframe(keyframe, structure, digest));
  }
  checkpoint();
  const std::string note = repairKeyframes(structure, keyframes);
  if (!note.empty()) set.repair_notes.push_back(note);
  checkKeyframes(structure, keyframes, mesh_unit_m);
  return keyframes;
}

}  // namespace

KeyframeSet readKeyframes(const Scene& scene) {
  checkFilesAreThere(scene);
  KeyframeSet set;
  Sha256 digest;
  for (const Structure& structure : scene.structures) {
    const double unit_m = metresPerMeshUnit(scene.motion);
    try {
      set.structures.push_back(soundKeyframes(structure, unit_m, digest, set));
    } catch (const SceneError& refusal) {
      throw SceneError(advised(refusal, structure, unit_m));
    }
  }
  set.sha256 = digest.hex();
  return set;
}

}  // namespace echocine
