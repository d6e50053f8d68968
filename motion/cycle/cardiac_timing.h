#pragma once
// How long each part of a heartbeat lasts at a heart rate, and where its events stand in the beat.
// Time counts from the R wave, which by our convention is end-diastole: the mitral valve closes
// there, so the electromechanical delay that clinical pre-ejection periods contain is left out.

namespace echocine {

enum class Ventricle { left, right };

struct PhaseDurations {
  double isovolumic_contraction_s, ejection_s, isovolumic_relaxation_s, rapid_filling_s,
      diastasis_s, atrial_kick_s;

  double endSystole() const { return isovolumic_contraction_s + ejection_s; }
  double filling() const { return rapid_filling_s + diastasis_s + atrial_kick_s; }
  double beat() const { return endSystole() + isovolumic_relaxation_s + filling(); }
};

// Durations of a beat of 1 / heart_rate_hz: none negative, none growing with the heart rate,
// together the beat. Both ventricles end their filling together and share the atrial kick's time.
// Precondition: heart_rate_hz over 0; the sources hold between 30 and 160 beats per minute.
PhaseDurations phaseDurations(double heart_rate_hz, Ventricle ventricle = Ventricle::left);

// Phases of the events, ascending in [0, 1); the right ventricle's valves are meant where the
// durations are the right ventricle's. Without a diastasis its begin is the atrial kick's.
struct CycleEvents {
  double mitral_closes, aortic_opens, aortic_closes, mitral_opens, diastasis_begins,
      atrial_kick_begins;
};
CycleEvents cycleEvents(const PhaseDurations& durations);

}  // namespace echocine
