#pragma once
// The resolved scene in SI units, for the manifest and for comparing scenes.

#include <nlohmann/json_fwd.hpp>

#include "scene/scene.h"

namespace echocine {

// Everything that can change an output, except file locations and execution settings.
nlohmann::ordered_json sceneJson(const Scene& scene);

// `name` -> Z, c, alpha_np_per_m, eta_b_per_m_sr.
nlohmann::ordered_json mediaJson(const Scene& scene);

}  // namespace echocine
