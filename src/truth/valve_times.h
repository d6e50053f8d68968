#pragma once
// When the valves of the left ventricle open and close, from its volume.

#include <optional>
#include <span>

namespace echocine {

// Phases of the beat in [0, 1).
struct ValveTimes {
  double mitral_closes = 0, aortic_opens = 0, aortic_closes = 0, mitral_opens = 0;
};

// volume_ml: of the cavity at even steps over one beat from phase 0. A valve is open while volume
// passes it: the ventricle is full, and both are closed, within 1 % of the stroke volume of its
// largest volume; empty within 0.2 % of its smallest. Nothing where the volume does not change.
std::optional<ValveTimes> valveTimes(std::span<const double> volume_ml);

}  // namespace echocine
