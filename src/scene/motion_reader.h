#pragma once
// [motion] of a scene file.

#include <optional>
#include <vector>

#include "core/error.h"
#include "scene/motion_settings.h"
#include "scene/scene.h"
#include "scene/toml_table.h"

namespace echocine {

// What becomes a setting only with the structures.
struct MotionKeys {
  std::optional<double> interval_s;  // between evenly spaced keyframes
  SourcePlace interval_place;
};

// Sets scene.motion. Throws SceneError.
MotionKeys readMotion(TomlTable table, Scene& scene);

// Beats per second of evenly spaced keyframes, of which each moving structure has as many; none
// without an interval. Throws SceneError where structures contradict it.
std::optional<double> rateOfInterval(const MotionKeys& keys,
                                     const std::vector<Structure>& structures);

}  // namespace echocine
