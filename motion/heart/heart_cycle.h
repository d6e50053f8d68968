#pragma once
// Timing of the heart: contraction, filling and valves over the beat.

#include "motion/cycle/cardiac_timing.h"
#include "motion/cycle/volume_curve.h"
#include "motion/heart/left_ventricle.h"
#include "motion/heart/parameters.h"

namespace echocine::heart {

struct State {
  Contraction left;
  double rv_ejected = 0;    // share of its stroke volume
  double atria_filled = 0;  // 0 after the kick, 1 at end-systole
  double mitral = 0, tricuspid = 0, aortic = 0, pulmonary = 0;  // 0 closed, 1 open
};

class Cycle {
 public:
  explicit Cycle(const Parameters& parameters);

  State at(double phase) const;  // phase in [0, 1), 0 the R wave and end-diastole
  const PhaseDurations& durations() const { return left_; }
  const CycleEvents& events() const { return left_events_; }  // of the left heart

 private:
  double opened(double phase, const CycleEvents& events) const;    // of an inflow valve
  double ejecting(double phase, const CycleEvents& events) const;  // of an outflow valve

  Parameters parameters_;
  PhaseDurations left_, right_;
  CycleEvents left_events_, right_events_;
  VolumeCurve left_curve_, right_curve_;
};

}  // namespace echocine::heart
