#pragma once
#include <cmath>

#include "motion/cycle/cardiac_clock.h"
#include "scene/scene.h"

namespace echocine {

// The instant at a time. A frame of the loop gets its exact time, free of the rounding of seconds.
inline FrameTime instantOf(const CardiacClock& clock, const Scene& scene, double time_s) {
  const double rate_hz = scene.acquisition.frame_rate_hz, number = std::round(time_s * rate_hz);
  if (number >= 0 && number < clock.frameCount() && std::abs(time_s * rate_hz - number) < 1e-6)
    return clock.at(static_cast<int>(number));
  FrameTime time = clock.atTime(time_s);
  time.frame = static_cast<int>(std::floor(time_s * rate_hz));
  return time;
}

}  // namespace echocine
