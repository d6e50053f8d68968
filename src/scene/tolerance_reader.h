#pragma once
// accuracy.tolerance_db of a scene file: a request for choosing accuracy settings, not part of the
// rendered scene.

#include <filesystem>
#include <optional>

#include "core/error.h"

namespace echocine {

struct SceneTolerance {
  double db = 0;
  SourcePlace place;
};

// None if the file has none. Throws SceneError if it cannot be read.
std::optional<SceneTolerance> readSceneTolerance(const std::filesystem::path& file);

}  // namespace echocine
