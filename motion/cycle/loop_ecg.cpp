#include "motion/cycle/loop_ecg.h"

#include <algorithm>

#include "motion/cycle/ecg.h"

namespace echocine {

std::vector<double> loopEcg(const CardiacClock& clock, double frame_rate_hz) {
  constexpr double kLeastPoints = 4096, kMostPoints = 1 << 18, kPointRate_hz = 200;
  const double loop_s = clock.frameCount() / frame_rate_hz;
  const auto points =
      static_cast<int>(std::clamp(loop_s * kPointRate_hz, kLeastPoints, kMostPoints));
  std::vector<double> lead;
  for (int i = 0; i < points; ++i) {
    const FrameTime time = clock.atTime(loop_s * i / (points - 1));
    lead.push_back(ecgAmplitude(time.time_in_beat_s, time.beat_s));
  }
  return lead;
}

}  // namespace echocine
