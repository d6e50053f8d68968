#include "motion/surfaces/keyframe_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <memory>

#include "core/error.h"
#include "core/hash.h"
#include "core/parallel.h"
#include "core/stop.h"
#include "motion/mesh/mesh_check.h"
#include "motion/mesh/mesh_io.h"
#include "motion/mesh/npz_meshes.h"
#include "motion/mesh/world_place.h"
#include "motion/repair/mesh_repair.h"
#include "motion/repair/repair_advice.h"
#include "scene/npz_keyframe.h"

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
        const auto npz = npzKeyframeOf(keyframe.files[i]);
        if (std::filesystem::status(npz ? npz->file : keyframe.files[i], failed).type() !=
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

// Position of a keyframe in the scene.
struct KeyframePlace {
  std::size_t structure, keyframe;
};

// A keyframe as read by one thread.
struct ReadMesh {
  KeyframeMesh mesh;
  std::vector<std::string> texts;   // for the digest
  std::exception_ptr refusal = {};  // a SceneError
};

// Reads all keyframes, up to the first that is refused. Returns for each structure the refusal of
// its first unusable file, if any. Structures after a refused one may be incomplete.
std::vector<std::exception_ptr> readAll(const Scene& scene, KeyframeSet& set) {
  std::vector<KeyframePlace> places;
  for (std::size_t s = 0; s < scene.structures.size(); ++s) {
    set.structures.emplace_back(scene.structures[s].keyframes.size());
    for (std::size_t k = 0; k < scene.structures[s].keyframes.size(); ++k) places.push_back({s, k});
  }
  std::vector<std::exception_ptr> refusals(scene.structures.size());
  std::atomic<bool> refused = false;
  const NpzFiles npz(scene.structures);
  Sha256 digest;
  const auto read = [&](std::size_t i) {
    checkpoint();
    auto made = std::make_shared<ReadMesh>();
    const Structure& structure = scene.structures[places[i].structure];
    try {
      made->mesh =
          readKeyframe(structure.keyframes[places[i].keyframe], structure, npz, made->texts);
    } catch (const SceneError&) {
      made->refusal = std::current_exception();
    }
    return made;
  };
  const auto take = [&](std::size_t i, const std::shared_ptr<void>& result) {
    auto& made = *static_cast<ReadMesh*>(result.get());
    if (refused) return;
    const auto [s, k] = places[i];
    refusals[s] = made.refusal;
    refused = made.refusal != nullptr;
    if (refused) return;
    addToDigest(scene.structures[s].keyframes[k], made.texts, digest);
    set.structures[s][k] = std::move(made.mesh);
  };
  // The texts of this many files are in memory at a time.
  const std::size_t in_flight = 2 * static_cast<std::size_t>(threadCount());
  parallelOrdered(
      0, places.size(), in_flight, [&] { return !refused; }, read, take);
  set.sha256 = digest.hex();
  return refusals;
}

// Repairs and checks a structure's keyframes. Returns the note of its repair.
std::string repairAndCheck(const Structure& structure, std::vector<KeyframeMesh>& keyframes,
                           double mesh_unit_m) {
  std::string note = repairKeyframes(structure, keyframes);
  checkKeyframes(structure, keyframes, mesh_unit_m);
  return note;
}

}  // namespace

// In parallel, with the first refusal in the scene's order for any number of threads.
KeyframeSet readKeyframes(const Scene& scene) {
  checkFilesAreThere(scene);
  KeyframeSet set;
  const double unit_m = metresPerMeshUnit(scene.motion);
  std::vector<std::exception_ptr> refusals = readAll(scene, set);
  const auto unusable = std::find_if(refusals.begin(), refusals.end(),
                                     [](const auto& refusal) { return refusal != nullptr; });
  // The structures before an unusable file are complete, and their faults come first.
  const auto complete = static_cast<std::size_t>(unusable - refusals.begin());
  std::vector<std::string> notes(complete);
  parallelBlocks(complete, 1, [&](std::size_t s, std::size_t) {
    try {
      notes[s] = repairAndCheck(scene.structures[s], set.structures[s], unit_m);
    } catch (const SceneError&) {
      refusals[s] = std::current_exception();
    }
  });
  for (std::size_t s = 0; s < scene.structures.size(); ++s) try {
      if (refusals[s]) std::rethrow_exception(refusals[s]);
    } catch (const SceneError& refusal) {
      throw SceneError(advised(refusal, scene.structures[s], unit_m));
    }
  for (std::string& note : notes)
    if (!note.empty()) set.repair_notes.push_back(std::move(note));
  return set;
}

}  // namespace echocine
