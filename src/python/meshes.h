#pragma once
// Keyframe meshes in Python's memory.

#include "scene/scene.h"
#include "scene/scene_reader.h"

namespace echocine::python {

struct Meshes {
  NamedMeshes named;
};

// The meshes with which a scene was read; empty if its keyframes are files.
Meshes meshesOf(const Scene& scene);

}  // namespace echocine::python
