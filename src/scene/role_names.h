#pragma once
// What a structure is of a heart, for truth that is told in anatomical terms.

#include <optional>
#include <string>
#include <string_view>

#include "scene/scene.h"

namespace echocine {

// lv_cavity, lv_wall, rv_cavity, la, mitral_valve, papillary_muscle, ...; empty where unknown.
std::string roleNameOf(const Structure& structure);

// The first structure of a role.
std::optional<SurfaceId> structureOf(const Scene& scene, std::string_view role);

}  // namespace echocine
