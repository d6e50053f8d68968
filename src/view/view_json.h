#pragma once
// A view as JSON for pages; heart_view.js reads it.

#include <nlohmann/json_fwd.hpp>

#include "view/scene_view.h"

namespace echocine {

// Lengths in mm. Positions of a structure are 16-bit steps from a corner of its bounding box,
// little endian and in base64, phase by phase. Indices are 16-bit, or 32-bit beyond 65536 vertices.
nlohmann::ordered_json viewJson(const SceneView& view, const Scene& scene);

}  // namespace echocine
