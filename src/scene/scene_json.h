#pragma once
// The scene as resolved, in SI units, for the manifest and for telling scenes apart.

#include <nlohmann/json_fwd.hpp>

#include "scene/scene.h"

namespace echocine {

// Everything that can change an output, except where files lie and how the run is carried out.
nlohmann::ordered_json sceneJson(const Scene& scene);

// `name` -> Z, c, alpha_np_per_m, eta_b_per_m_sr.
nlohmann::ordered_json mediaJson(const Scene& scene);

}  // namespace echocine
