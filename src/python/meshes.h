#pragma once
// Keyframe meshes in Python's memory.

#include <string>

#include "scene/scene.h"
#include "scene/scene_reader.h"

namespace echocine::python {

struct Meshes {
  NamedMeshes named;
  std::string heart_truth;  // truth.json of the parametric heart that these are; empty: another's
};

// The meshes with which a scene was read; empty if its keyframes are files.
Meshes meshesOf(const Scene& scene);

}  // namespace echocine::python
