#pragma once
// [motion] of a scene file.

#include <optional>
#include <vector>

#include "core/error.h"
#include "scene/motion_settings.h"
#include "scene/scene.h"
#include "scene/toml_table.h"

namespace echocine {

// Keys that become settings together with the structures.
struct MotionKeys {
  std::optional<double> interval_s;  // between evenly spaced keyframes
  SourcePlace interval_place;
};

// Sets scene.motion. Throws SceneError.
MotionKeys readMotion(TomlTable table, Scene& scene);

// Beats per second of evenly spaced keyframes, the same number for each moving structure; none
// without an interval. Throws SceneError if structures contradict it.
std::optional<double> rateOfInterval(const MotionKeys& keys,
                                     const std::vector<Structure>& structures);

}  // namespace echocine
