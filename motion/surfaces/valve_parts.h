#pragma once
// Parts of valves that only the picture shows, beside the meshes.

#include <memory>

#include "motion/surfaces/chordae.h"
#include "motion/surfaces/leaflet_bodies.h"
#include "motion/surfaces/valve_rings.h"

namespace echocine {

// Null: the picture has none.
struct ValveParts {
  std::shared_ptr<const LeafletBodies> leaflets{};
  std::shared_ptr<const Chordae> chordae{};
  std::shared_ptr<const ValveRings> rings{};
};

}  // namespace echocine
