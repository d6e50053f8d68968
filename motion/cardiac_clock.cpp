#include "motion/cardiac_clock.h"

#include <algorithm>
#include <cmath>

namespace echocine {

namespace {

// Whole beats are seldom representable: 65 bpm at 50 Hz reaches 0.9999999999999999 of a beat where
// 1 is meant. Within this many cycles of a whole beat it is the whole beat (1e-9 of a beat is 1
// ns).
constexpr double kWholeBeatTolerance = 1e-9;

double phaseOf(double cycles) {
  const double whole = std::round(cycles);
  if (std::fabs(cycles - whole) <= kWholeBeatTolerance) return 0;
  return cycles - std::floor(cycles);
}

}  // namespace

int CardiacClock::frameCount() const {
  const double intervals =
      acquisition_.beats * acquisition_.frame_rate_hz / acquisition_.heart_rate_hz;
  return static_cast<int>(std::max(1L, std::lround(intervals)));
}

FrameTime CardiacClock::at(int frame) const {
  const double time_s = frame / acquisition_.frame_rate_hz;
  return {time_s, phaseOf(frame * acquisition_.heart_rate_hz / acquisition_.frame_rate_hz)};
}

}  // namespace echocine
