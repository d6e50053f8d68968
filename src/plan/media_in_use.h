#pragma once
// Which media a scene holds, and in what they differ.

#include <vector>

#include "scene/scene.h"

namespace echocine {

// The background's first, then each structure's, also when two have the same. They live as long as
// the scene.
std::vector<const Medium*> mediaInUse(const Scene& scene);

// Does any differ from another in what the tracer knows of it, or in sound speed?
bool mediaDiffer(const Scene& scene);
bool speedsDiffer(const Scene& scene);

}  // namespace echocine
