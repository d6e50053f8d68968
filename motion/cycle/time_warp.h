#pragma once
// Playback of keyframes at another heart rate. At twice the rate a heart does not contract twice as
// fast: systole keeps most of its duration, and diastole is shortened. So all events of the beat
// are aligned, not only its start and end.

#include <array>
#include <optional>

namespace echocine {

// The beat of the keyframes.
struct RecordedBeat {
  double heart_rate_hz = 1;
  // Aortic valve closure of the keyframes, in (0, 1); default: that of phaseDurations().
  std::optional<double> end_systole_phase;
};

// The map of one beat: monotone cubics between the events, continuous in slope. The slope is 1 at
// the R wave, so beats of any lengths join without a kink wherever the events permit (the slope is
// at most three times an interval's mean).
class TimeWarp {
 public:
  // beat_s: duration of the beat played, over 0.
  TimeWarp(const RecordedBeat& recorded, double beat_s);

  // Phase of the keyframes in [0, 1] at a time in [0, beat] after the R wave. For a beat of the
  // recorded duration it is the identity within rounding.
  double phaseAt(double time_s) const;

  // Aortic valve closure in the beat played. Without an end_systole_phase it is that of
  // phaseDurations(); with one, the ratio of systole to diastole changes by the same factor.
  double endSystole() const { return end_systole_s_; }

 private:
  struct Knot {
    double time_s = 0, recorded_s = 0;
    double slope = 1;  // recorded time per time
  };
  void setSlopes();

  std::array<Knot, 7> knots_{};  // R wave, five events, next R wave
  double recorded_beat_s_, end_systole_s_;
};

}  // namespace echocine
