#pragma once
// Opening and closing times of the left ventricle's valves, from its volume.

#include <optional>
#include <span>

namespace echocine {

// Phases of the beat in [0, 1).
struct ValveTimes {
  double mitral_closes = 0, aortic_opens = 0, aortic_closes = 0, mitral_opens = 0;
};

// volume_ml: of the cavity at even steps over one beat from phase 0. A valve is open while there is
// flow through it. The aortic valve closes when the volume comes within 0.2 % of the stroke volume
// of its minimum. The other times are extrapolated to zero flow, for flow that begins and ends
// linearly in time: from 1 and 2 % below the maximum, and from 0.2 and 0.4 % above the minimum.
// None if the volume is constant.
std::optional<ValveTimes> valveTimes(std::span<const double> volume_ml);

}  // namespace echocine
