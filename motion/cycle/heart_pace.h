#pragma once
// How fast a heart goes through its shapes: the way between two known instants of the beat, as the
// published volume curve divides it.

#include "motion/cycle/time_warp.h"
#include "motion/cycle/volume_curve.h"

namespace echocine {

// Where the aortic valve closes in a beat whose smallest volume was seen at `phase`, in (0, 1). A
// segmentation's end-systole is its smallest picture, which may stem from any instant of isovolumic
// relaxation: timing stays as published for the rate while that phase lies within it, and moves as
// little as puts the phase at its nearer end otherwise. Our choice.
double endSystoleAround(double phase, double heart_rate_hz);

class HeartPace {
 public:
  // A heart at rest, 65 beats per minute.
  HeartPace() : HeartPace(RecordedBeat{65.0 / 60.0, {}}) {}
  explicit HeartPace(const RecordedBeat& beat);

  // The way from the R wave to a phase in [0, 2), in stroke volumes: what the ventricle has given
  // out and taken in, and a little that goes with time (kDrift). It ascends strictly and has
  //   travelled(phase + 1) = travelled(phase) + travelled(1).
  // Where the volume only falls or only rises between two phases, the share of the way there is
  // the share of the volume, but for the drift.
  double travelled(double phase) const;

  // Of travelled() over a beat, in stroke volumes: a heart whose volume stands still moves on too.
  // Our choice.
  static constexpr double kDrift = 0.02;

 private:
  double inBeat(double phase) const;  // travelled() of a phase in [0, 1]

  VolumeCurve curve_;
  double published_end_systole_, end_systole_;  // phases: of the curve, of this beat
};

}  // namespace echocine
