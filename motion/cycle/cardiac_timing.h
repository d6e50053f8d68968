#pragma once
// Durations of the parts of a heartbeat at a heart rate, and phases of its events. Time counts from
// the R wave. By our convention this is end-diastole: the mitral valve closes there, so the
// electromechanical delay of clinical pre-ejection periods is omitted.

namespace echocine {

enum class Ventricle { left, right };

struct PhaseDurations {
  double isovolumic_contraction_s, ejection_s, isovolumic_relaxation_s, rapid_filling_s,
      diastasis_s, atrial_kick_s;

  double endSystole() const { return isovolumic_contraction_s + ejection_s; }
  double filling() const { return rapid_filling_s + diastasis_s + atrial_kick_s; }
  double beat() const { return endSystole() + isovolumic_relaxation_s + filling(); }
};

// Durations of a beat of 1 / heart_rate_hz. None is negative, none grows with the heart rate, and
// they sum to the beat. Both ventricles end their filling together and share the time of the atrial
// kick. Precondition: heart_rate_hz > 0; the sources cover 30 to 160 beats per minute.
PhaseDurations phaseDurations(double heart_rate_hz, Ventricle ventricle = Ventricle::left);

// Phases of the events, ascending in [0, 1). For durations of the right ventricle they are those of
// its valves. Without a diastasis its start is that of the atrial kick.
struct CycleEvents {
  double mitral_closes, aortic_opens, aortic_closes, mitral_opens, diastasis_begins,
      atrial_kick_begins;
};
CycleEvents cycleEvents(const PhaseDurations& durations);

}  // namespace echocine
