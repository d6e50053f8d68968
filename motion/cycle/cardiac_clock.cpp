#include "motion/cycle/cardiac_clock.h"

#include <algorithm>
#include <cmath>

#include "motion/cycle/beat_duration.h"

namespace echocine {

namespace {

// Whole beats are seldom representable: 65 bpm at 50 Hz reaches 0.9999999999999999 of a beat
// instead of 1. Within this many cycles of a whole beat it counts as whole (1e-9 of a beat is 1
// ns).
constexpr double kWholeBeatTolerance = 1e-9;

double phaseOf(double cycles) {
  const double whole = std::round(cycles);
  if (std::fabs(cycles - whole) <= kWholeBeatTolerance) return 0;
  return cycles - std::floor(cycles);
}

// The end of a beat is the next R wave for the keyframes, too.
double wrapped(double phase) {
  return phase >= 1 - kWholeBeatTolerance ? 0 : phase;
}

}  // namespace

CardiacClock::CardiacClock(const Acquisition& acquisition, const MotionSettings& motion)
    : acquisition_(acquisition) {
  const bool steady = acquisition.rr_variability == 0;
  const bool same_rate =
      steady && motion.keyframe_heart_rate_hz == acquisition.heart_rate_hz;  // nothing to warp
  if (motion.keyframe_heart_rate_hz && acquisition.time_warp != WarpChoice::uniform && !same_rate)
    recorded_ = {*motion.keyframe_heart_rate_hz, motion.end_systole_phase};
  if (steady) {
    if (recorded_) steady_warp_.emplace(*recorded_, 1 / acquisition.heart_rate_hz);
    return;
  }
  // Rounding to whole frames may take the loop past its last beat, by up to a frame's time.
  const double past_s = 1 / acquisition.frame_rate_hz;
  double start_s = 0;
  for (std::int64_t beat = 0;; ++beat) {
    starts_s_.push_back(start_s);
    if (static_cast<double>(beat) > acquisition.beats + 1 && start_s > duration() + past_s) break;
    start_s += beatDuration(acquisition, beat);
  }
}

double CardiacClock::duration() const {
  const auto whole = static_cast<std::size_t>(std::floor(acquisition_.beats));
  const double part = acquisition_.beats - static_cast<double>(whole);
  return std::lerp(starts_s_[whole], starts_s_[whole + 1], part);
}

int CardiacClock::frameCount() const {
  const double intervals = starts_s_.empty() ? acquisition_.beats * acquisition_.frame_rate_hz /
                                                   acquisition_.heart_rate_hz
                                             : duration() * acquisition_.frame_rate_hz;
  return static_cast<int>(std::max(1L, std::lround(intervals)));
}

FrameTime CardiacClock::inSteadyBeats(double time_s, double cycles) const {
  FrameTime t{time_s, phaseOf(cycles)};
  t.beat_s = 1 / acquisition_.heart_rate_hz;
  t.beat = static_cast<int>(std::lround(cycles - t.phase));
  t.time_in_beat_s = t.phase * t.beat_s;
  if (steady_warp_) t.phase = wrapped(steady_warp_->phaseAt(t.time_in_beat_s));
  return t;
}

// Before the start of the loop an identical beat is assumed.
FrameTime CardiacClock::inVariedBeats(double time_s) const {
  if (time_s < 0) {
    FrameTime t = inVariedBeats(starts_s_[1] + time_s);
    t.time_s = time_s;
    t.beat = -1;
    return t;
  }
  const double tolerance_s = kWholeBeatTolerance / acquisition_.heart_rate_hz;
  const auto next =
      std::upper_bound(starts_s_.begin() + 1, starts_s_.end() - 1, time_s + tolerance_s);
  FrameTime t{time_s};
  t.beat = static_cast<int>(next - starts_s_.begin()) - 1;
  t.beat_s = *next - *(next - 1);
  t.time_in_beat_s = std::max(0.0, time_s - *(next - 1));
  t.phase = wrapped(recorded_ ? TimeWarp(*recorded_, t.beat_s).phaseAt(t.time_in_beat_s)
                              : t.time_in_beat_s / t.beat_s);
  return t;
}

FrameTime CardiacClock::at(int frame) const {
  const double time_s = frame / acquisition_.frame_rate_hz;
  FrameTime t =
      starts_s_.empty()
          ? inSteadyBeats(time_s, frame * acquisition_.heart_rate_hz / acquisition_.frame_rate_hz)
          : inVariedBeats(time_s);
  t.frame = frame;
  return t;
}

FrameTime CardiacClock::atTime(double time_s) const {
  if (!starts_s_.empty()) return inVariedBeats(time_s);
  return inSteadyBeats(time_s, time_s * acquisition_.heart_rate_hz);
}

}  // namespace echocine
