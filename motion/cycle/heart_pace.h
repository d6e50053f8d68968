#pragma once
// Pace of the shape changes of a heart: progress between two instants of the beat, from the
// published volume curve.

#include "motion/cycle/time_warp.h"
#include "motion/cycle/volume_curve.h"

namespace echocine {

// Phase of aortic valve closure in a beat whose smallest volume was observed at `phase`, in (0, 1).
// A segmentation's end-systole is its smallest picture, which can be any instant of isovolumic
// relaxation. The published timing is kept if that phase lies within it; otherwise the timing is
// moved until the phase is at its nearer end. Our choice.
double endSystoleAround(double phase, double heart_rate_hz);

class HeartPace {
 public:
  // A heart at rest, 65 beats per minute.
  HeartPace() : HeartPace(RecordedBeat{65.0 / 60.0, {}}) {}
  explicit HeartPace(const RecordedBeat& beat);

  // Progress from the R wave to a phase in [0, 2), in stroke volumes: what the ventricle has
  // ejected and filled, plus a small drift in time (kDrift). It is strictly increasing and has
  //   travelled(phase + 1) = travelled(phase) + travelled(1).
  // Between two phases of monotone volume, the fraction of the progress is the fraction of the
  // volume, except for the drift.
  double travelled(double phase) const;

  // Part of travelled() over a beat, in stroke volumes, so that a heart of constant volume moves
  // too. Our choice.
  static constexpr double kDrift = 0.02;

 private:
  double inBeat(double phase) const;  // travelled() of a phase in [0, 1]

  VolumeCurve curve_;
  double published_end_systole_, end_systole_;  // phases: of the curve, of this beat
};

}  // namespace echocine
