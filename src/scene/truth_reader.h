#pragma once
// The [truth] table of a scene.

#include <string>
#include <vector>

#include "scene/scene.h"
#include "scene/toml_table.h"

namespace echocine {

// Kinds of truth by name, as in truth.write and render --truth.
inline constexpr const char* kTruthKinds = "all, labels, contours, tracks, function";

// Enables the named kinds. Returns the first unknown name, or an empty text. "all" leaves out
// tracks and function if no structure is the left ventricle or its wall, and adds a warning to the
// scene. Precondition: the scene has its structures.
std::string switchOn(const std::vector<std::string>& kinds, Scene& scene);

// Sets scene.truth. Checks numbers and names against the scene's structures.
void readTruth(TomlTable table, Scene& scene);

}  // namespace echocine
