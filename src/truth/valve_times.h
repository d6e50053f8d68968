#pragma once
// Opening and closing times of the left ventricle's valves, from its volume.

#include <optional>
#include <span>

namespace echocine {

// Phases of the beat in [0, 1).
struct ValveTimes {
  double mitral_closes = 0, aortic_opens = 0, aortic_closes = 0, mitral_opens = 0;
};

// volume_ml: of the cavity at even steps over one beat from phase 0. A valve is open while volume
// passes it. Both are closed while the volume is within 1 % of the stroke volume of its maximum, or
// within 0.2 % of its minimum. None if the volume is constant.
std::optional<ValveTimes> valveTimes(std::span<const double> volume_ml);

}  // namespace echocine
