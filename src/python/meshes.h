#pragma once
// Keyframe meshes that Python holds in memory.

#include "scene/scene.h"
#include "scene/scene_reader.h"

namespace echocine::python {

struct Meshes {
  NamedMeshes named;
};

// Those that a scene was read with; none where its keyframes are files.
Meshes meshesOf(const Scene& scene);

}  // namespace echocine::python
