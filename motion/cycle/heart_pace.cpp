#include "motion/cycle/heart_pace.h"

#include <cmath>

namespace echocine {

HeartPace::HeartPace(const RecordedBeat& beat)
    : curve_(phaseDurations(beat.heart_rate_hz)),
      published_end_systole_(cycleEvents(phaseDurations(beat.heart_rate_hz)).aortic_closes),
      end_systole_(beat.end_systole_phase.value_or(published_end_systole_)) {}

double endSystoleAround(double phase, double heart_rate_hz) {
  const CycleEvents published = cycleEvents(phaseDurations(heart_rate_hz));
  if (phase <= published.aortic_closes) return phase;
  if (phase <= published.mitral_opens) return published.aortic_closes;
  // Diastole is stretched as a whole, so relaxation keeps its fraction of it.
  const double relaxation =
      (published.mitral_opens - published.aortic_closes) / (1 - published.aortic_closes);
  return (phase - relaxation) / (1 - relaxation);
}

// Systole and diastole are each stretched to this beat's end-systole.
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
