#pragma once
// Keyframes recorded at one heart rate, played at another. A heart that beats twice as fast does
// not contract twice as fast: systole keeps most of its time and diastole gives the rest. So the
// events of the beat, not its start and end alone, are made to fall together.

#include <array>
#include <optional>

namespace echocine {

// The beat that the keyframes show.
struct RecordedBeat {
  double heart_rate_hz = 1;
  // Where the keyframes' aortic valve closes, in (0, 1); that of phaseDurations() if left out.
  std::optional<double> end_systole_phase;
};

// The map of one beat: cubics between the events, one slope on both sides of each, never going
// back. The keyframes run in real time at the R wave, so beats of any lengths join without a kink
// wherever the events leave that slope room (time runs at most threefold of an interval's mean).
class TimeWarp {
 public:
  // beat_s: duration of the beat that is played, over 0.
  TimeWarp(const RecordedBeat& recorded, double beat_s);

  // Phase of the keyframes in [0, 1] at a time in [0, beat] after the R wave; the identity
  // but for rounding where the beat lasts as long as the recorded one.
  double phaseAt(double time_s) const;

  // Where the aortic valve closes in the beat that is played. Without an end_systole_phase it is
  // that of phaseDurations(); with one the ratio of systole to the rest of the beat changes as
  // there.
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
