#pragma once
// A recorded heart as a scene: its text for files, or with its meshes in memory.

#include <cstddef>
#include <string>

#include "motion/heart/parameters.h"
#include "scene/scene_reader.h"

namespace echocine::heart {

using echocine::View;
struct RecordedPart;
struct Recording;

// The name of a part's keyframe: "lv_wall_07.obj", "abdomen.obj" of what stands still.
std::string meshName(const RecordedPart& part, std::size_t keyframe);

// The scene that renders a recording, as TOML, its meshes found under `mesh_folder` ("" for the
// scene's own, else with a slash at its end), its pictures with a look.
std::string sceneText(View view, const Parameters& parameters, const Recording& recording,
                      const std::string& mesh_folder, Look look = Look::scanner);

// The keyframes of a recording by the names that sceneText() has for them.
NamedMeshes meshesOf(const Recording& recording);

// The same scene with its keyframes in memory: what writing and reading files would give, without
// them. `view`, `parameters`: those of the recording.
Scene sceneOf(View view, const Parameters& parameters, const Recording& recording,
              Look look = Look::scanner);

// A heart from its dials, recorded at `keyframes` instants: all of the above in one call. Runs in
// parallel inside withThreads(). Throws SceneError for parameters that no heart fulfils.
Scene heartScene(const Parameters& parameters, View view, int keyframes = 24,
                 Look look = Look::scanner);

}  // namespace echocine::heart
