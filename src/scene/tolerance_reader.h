#pragma once
// accuracy.tolerance_db of a scene file: a wish about how its accuracy is set, which is no part of
// the scene that is rendered.

#include <filesystem>
#include <optional>

#include "core/error.h"

namespace echocine {

struct SceneTolerance {
  double db = 0;
  SourcePlace place;
};

// Nothing where the file has none. Throws SceneError when it cannot be read.
std::optional<SceneTolerance> readSceneTolerance(const std::filesystem::path& file);

}  // namespace echocine
