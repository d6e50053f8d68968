#pragma once
// The meshes of a scene's keyframes, read or taken from memory, repaired and checked.

#include <string>
#include <vector>

#include "motion/mesh/mesh.h"
#include "scene/scene.h"

namespace echocine {

struct KeyframeSet {
  std::vector<std::vector<KeyframeMesh>> structures;  // by SurfaceId, then keyframe; mesh units
  std::vector<std::string> repair_notes;              // repairs done, a line for each structure
  std::string sha256;                                 // over all meshes, in the scene's order
};

// Reads and checks every keyframe of every structure. Throws SceneError naming the scene's place,
// the file and the face or vertex.
KeyframeSet readKeyframes(const Scene& scene);

}  // namespace echocine
