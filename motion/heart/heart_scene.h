#pragma once
// A recorded heart as a scene: as text for files, or with meshes in memory.

#include <cstddef>
#include <string>

#include "motion/heart/parameters.h"
#include "scene/scene_reader.h"

namespace echocine::heart {

using echocine::View;
struct RecordedPart;
struct Recording;

// Files of the keyframes: an OBJ file for each, or a NumPy file for each part.
enum class MeshFormat { obj, npz };

// The name of a part's keyframe: "lv_wall_07.obj"; "abdomen.obj" for a static part.
std::string meshName(const RecordedPart& part, std::size_t keyframe);

// The scene that renders a recording, as TOML. Meshes are under `mesh_folder` ("" for the scene's
// own folder, otherwise with a trailing slash).
std::string sceneText(View view, const Parameters& parameters, const Recording& recording,
                      const std::string& mesh_folder, Look look = Look::scanner,
                      MeshFormat format = MeshFormat::obj);

// The keyframes of a recording by their names in sceneText().
NamedMeshes meshesOf(const Recording& recording);

// The same scene with its keyframes in memory: equal to writing and reading files. `view`,
// `parameters`: those of the recording.
Scene sceneOf(View view, const Parameters& parameters, const Recording& recording,
              Look look = Look::scanner);

// A heart from its dials with `keyframes` instants by motion. Runs in parallel inside
// withThreads(). Throws SceneError for impossible parameters.
Recording heartRecording(const Parameters& parameters, View view, int keyframes);

// All of the above in one call. Throws likewise.
Scene heartScene(const Parameters& parameters, View view, int keyframes = 24,
                 Look look = Look::scanner);

}  // namespace echocine::heart
