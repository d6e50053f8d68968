#include "motion/cycle/r_waves.h"

#include <algorithm>

namespace echocine {

std::vector<double> rWaves(std::span<const FrameTime> frames) {
  constexpr double kRounding_s = 1e-9;
  std::vector<double> waves_s;
  int beat = -1;
  for (const FrameTime& time : frames) {
    if (time.beat == beat) continue;
    beat = time.beat;
    const double wave_s = time.time_s - time.time_in_beat_s - frames.front().time_s;
    if (wave_s > -kRounding_s) waves_s.push_back(std::max(0.0, wave_s));
  }
  return waves_s;
}

}  // namespace echocine
