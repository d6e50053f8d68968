#include "motion/cycle/heart_pace.h"

#include <cmath>

namespace echocine {

HeartPace::HeartPace(const RecordedBeat& beat)
    : curve_(phaseDurations(beat.heart_rate_hz)),
      published_end_systole_(cycleEvents(phaseDurations(beat.heart_rate_hz)).aortic_closes),
      end_systole_(beat.end_systole_phase.value_or(published_end_systole_)) {}

// Systole and the rest of the beat are each stretched to where this beat's end-systole stands.
double HeartPace::inBeat(double phase) const {
  const double drift = kDrift * phase;
  if (phase <= end_systole_)
    return 1 - curve_.at(phase / end_systole_ * published_end_systole_) + drift;
  const double rest = (phase - end_systole_) / (1 - end_systole_);
  return 1 + curve_.at(published_end_systole_ + rest * (1 - published_end_systole_)) + drift;
}

double HeartPace::travelled(double phase) const {
  const double beats = std::floor(phase);
  return beats * (2 + kDrift) + inBeat(phase - beats);
}

}  // namespace echocine
