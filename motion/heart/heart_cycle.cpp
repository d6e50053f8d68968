#include "motion/heart/heart_cycle.h"

#include <algorithm>
#include <cmath>

#include "core/monotone_cubic.h"
#include "motion/heart/smooth.h"

namespace echocine::heart {
namespace {

// Opening and closing times of leaflets, s; our choice, from the slopes of healthy M-mode tracings.
constexpr double kInflowOpens_s = 0.045, kInflowCloses_s = 0.045, kOutflowMoves_s = 0.030;
// Opening of the inflow valves between rapid filling and the kick, and in the kick; our choice.
constexpr double kAjar = 0.35, kKickOpening = 0.80;

double wrapped(double phase) {
  return phase - std::floor(phase);
}

}  // namespace

Cycle::Cycle(const Parameters& parameters)
    : parameters_(parameters),
      left_(phaseDurations(parameters.heart_rate_bpm / 60)),
      right_(phaseDurations(parameters.heart_rate_bpm / 60, Ventricle::right)),
      left_events_(cycleEvents(left_)),
      right_events_(cycleEvents(right_)),
      left_curve_(left_, parameters.atrial_share),
      right_curve_(right_, parameters.atrial_share) {}

// Fully open in rapid filling, half open in diastasis, open again in the kick, closed at
// end-diastole.
double Cycle::opened(double phase, const CycleEvents& events) const {
  const double beat_s = left_.beat();
  if (phase < events.mitral_opens) return 0;
  const double opens = smoothStep(0, kInflowOpens_s, (phase - events.mitral_opens) * beat_s);
  const double middle = 0.5 * (events.mitral_opens + events.diastasis_begins);
  const double ajar = std::lerp(1.0, kAjar, smoothStep(middle, events.diastasis_begins, phase));
  const double kick = smoothStep(0, kInflowOpens_s, (phase - events.atrial_kick_begins) * beat_s);
  const double shuts = smoothStep(-kInflowCloses_s, 0, (phase - 1) * beat_s);
  return opens * std::max(ajar, kKickOpening * kick) * (1 - shuts);
}

double Cycle::ejecting(double phase, const CycleEvents& events) const {
  const double beat_s = left_.beat();
  const double opens = smoothStep(0, kOutflowMoves_s, (phase - events.aortic_opens) * beat_s);
  const double shuts = smoothStep(-kOutflowMoves_s, 0, (phase - events.aortic_closes) * beat_s);
  return opens * (1 - shuts);
}

State Cycle::at(double phase) const {
  State state;
  state.left.ejected = 1 - left_curve_.at(phase);
  for (int s = 0; s < kSegments; ++s) {
    const Segment& segment = parameters_.segments[s];
    const double late = wrapped(phase - segment.delay_s / left_.beat());
    state.left.segments[s] = segment.amplitude * (1 - left_curve_.at(late));
  }
  state.rv_ejected = 1 - right_curve_.at(phase);
  // Reservoir with closed inflow valves, conduit in early filling, pump in the kick. The levels are
  // our choice.
  const CycleEvents& e = left_events_;
  const double kick = std::max(e.atrial_kick_begins, e.diastasis_begins + 0.01);
  const MonotoneCubic atria({{0, 0},
                             {0.45 * e.mitral_opens, 0.62},
                             {e.mitral_opens, 1},
                             {e.diastasis_begins, 0.48},
                             {kick, 0.46},
                             {1, 0}});
  state.atria_filled = atria(phase);
  state.mitral = opened(phase, e) * parameters_.mitral_opening;
  state.tricuspid = opened(phase, right_events_) * parameters_.tricuspid_opening;
  state.aortic = ejecting(phase, e) * parameters_.aortic_opening;
  state.pulmonary = ejecting(phase, right_events_);
  return state;
}

}  // namespace echocine::heart
