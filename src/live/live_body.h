#pragma once
// Bodies of requests: JSON objects whose fields are known.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "live/heart_dials.h"
#include "scene/scene.h"

namespace echocine::live {

using LiveJson = nlohmann::ordered_json;

// The body as JSON; none if it is not, or is nested so deeply that reading it takes the stack.
std::optional<LiveJson> jsonOf(const std::string& body);

// Empty, or why the body is refused: an unknown field, or a value of another kind. All fields are
// optional for this function.
std::string faultOf(const LiveJson& body);

const LiveJson& keysOf(const LiveJson& body);  // an empty object without the field
int frameOf(const LiveJson& body);             // 0 without the field
HeartChange heartChangeOf(const LiveJson& body);
bool hasLayer(const LiveJson& body, const std::string& layer);

// A pose as keys of the scene, in its mesh unit.
LiveJson poseJson(Vec3d apex_m, Vec3d axis, Vec3d lateral, const Scene& scene);
bool isPoseKey(std::string_view key);
// A pose of three lists of three numbers, if it is one; otherwise the scene's reader says why not.
std::optional<Pose> poseFrom(const LiveJson& keys, const Scene& scene);

// A file name without folders that ends in .toml.
bool isSceneName(const std::string& name);

}  // namespace echocine::live
