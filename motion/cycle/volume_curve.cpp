#include "motion/cycle/volume_curve.h"

#include <algorithm>
#include <cmath>

namespace echocine {

namespace {

// Filling at rest: 70 % rapid, 20 % in diastasis, 10 % by the atrial kick. Our choice: rest is at
// most 70 bpm. A shorter diastasis fills less at the same flow, and the kick fills the rest of its
// 20 %, up to 30 % without diastasis.
constexpr double kDiastasisAtRest = 0.20, kKickAtRest = 0.10, kRest_hz = 70.0 / 60.0;

// Time of peak flow within ejection, 0 to 1: its first third. Our choice.
constexpr double kPeakEjection = 1.0 / 3;

// Fraction ejected at t in [0, 1] of the ejection. The rate is (b+1)(b+2) t (1-t)^b, which peaks at
// 1 / (1+b) and is 0 at both ends.
double ejected(double t) {
  constexpr double b = 1 / kPeakEjection - 1;
  return 1 - std::pow(1 - t, b + 1) * (1 + (b + 1) * t);
}

// Cubic from 0 to `rise` over `width` with the slopes given at its ends (Hermite). Monotone while
// neither slope is over 3 rise / width.
double cubic(double x, double width, double rise, double first_slope, double last_slope) {
  const double t = x / width, u = 1 - t;
  return rise * t * t * (3 - 2 * t) + width * t * u * (first_slope * u - last_slope * t);
}

}  // namespace

VolumeCurve::VolumeCurve(const PhaseDurations& durations, std::optional<double> kick_share)
    : events_(cycleEvents(durations)) {
  const double at_rest_s = phaseDurations(kRest_hz).diastasis_s;
  diastasis_share_ = kDiastasisAtRest * std::min(1.0, durations.diastasis_s / at_rest_s);
  kick_share_ = kKickAtRest + kDiastasisAtRest - diastasis_share_;
  // The flow of diastasis is kept as its duration goes to 0, so the curve changes smoothly with the
  // rate, and rapid filling merges into the kick.
  diastasis_slope_ =
      kDiastasisAtRest / std::max(at_rest_s, durations.diastasis_s) * durations.beat();
  if (!kick_share) return;
  const double rest =
      (1 - *kick_share) / (1 - kick_share_);  // rapid filling and diastasis share the rest
  diastasis_share_ *= rest;
  diastasis_slope_ *= rest;
  kick_share_ = *kick_share;
}

double VolumeCurve::at(double phase) const {
  const CycleEvents& e = events_;
  if (phase <= e.aortic_opens) return 1;
  if (phase < e.aortic_closes)
    return 1 - ejected((phase - e.aortic_opens) / (e.aortic_closes - e.aortic_opens));
  if (phase <= e.mitral_opens) return 0;
  if (phase < e.diastasis_begins)
    return cubic(phase - e.mitral_opens, e.diastasis_begins - e.mitral_opens, rapidShare(), 0,
                 diastasis_slope_);
  if (phase < e.atrial_kick_begins)
    return rapidShare() + diastasis_slope_ * (phase - e.diastasis_begins);
  if (phase >= 1) return 1;
  return 1 - kick_share_ +
         cubic(phase - e.atrial_kick_begins, 1 - e.atrial_kick_begins, kick_share_,
               diastasis_slope_, 0);
}

}  // namespace echocine
