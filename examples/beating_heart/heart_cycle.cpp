#include "examples/beating_heart/heart_cycle.h"

#include <cmath>
#include <cstddef>
#include <span>

namespace echocine::beating_heart {
namespace {

// Phases of a beat of 923 ms. Contraction 40 ms and relaxation 96 ms at constant volume as measured
// in the Copenhagen City Heart Study; ejection 379 - 1.8 * 65 = 262 ms.
constexpr double kAorticOpening = 0.043, kAorticClosure = 0.327, kMitralOpening = 0.431;
constexpr double kRapidFillingEnd = 0.62, kAtrialKick = 0.82, kAtrialKickEnd = 0.985;

struct Knot {
  double phase;
  double value;
};

// Through the knots, at rest at each of them.
double easedThrough(std::span<const Knot> knots, double phase) {
  std::size_t i = 1;
  while (i + 1 < knots.size() && knots[i].phase <= phase) ++i;
  const Knot from = knots[i - 1], to = knots[i];
  const double t = (phase - from.phase) / (to.phase - from.phase);
  return from.value + (to.value - from.value) * t * t * (3 - 2 * t);
}

// Share of the stroke volume that has left a ventricle: rapid filling brings back 70 %, diastasis
// 20 %, the atrial kick 10 %.
double ejectedShare(double phase) {
  if (phase > kAorticOpening && phase < kAorticClosure) {
    const double t = (phase - kAorticOpening) / (kAorticClosure - kAorticOpening);
    const double early = 1 - std::pow(1 - t, 1.4);  // flow peaks in the first half of ejection
    return early * early * (3 - 2 * early);
  }
  constexpr Knot kFilling[] = {{kAorticClosure, 1}, {kMitralOpening, 1}, {kRapidFillingEnd, 0.3},
                               {kAtrialKick, 0.1},  {kAtrialKickEnd, 0}, {1, 0}};
  return phase <= kAorticOpening ? 0 : easedThrough(kFilling, phase);
}

// Share of an atrium's filling: in while the ventricle ejects, out in rapid filling and in the
// kick.
double atrialShare(double phase) {
  constexpr Knot kCurve[] = {{0, 0},
                             {0.40, 1},
                             {kMitralOpening, 1},
                             {kRapidFillingEnd, 0.48},
                             {kAtrialKick, 0.45},
                             {kAtrialKickEnd, 0},
                             {1, 0}};
  return easedThrough(kCurve, phase);
}

// Wide open in the E wave, half closed in diastasis, open again in the A wave.
double leafletOpening(double phase) {
  constexpr Knot kCurve[] = {
      {0, 0}, {kMitralOpening - 0.03, 0}, {0.52, 1}, {0.66, 0.42}, {0.80, 0.40}, {0.89, 0.80},
      {1, 0}};
  return easedThrough(kCurve, phase);
}

}  // namespace

HeartState heartStateAt(double phase) {
  const double ejected = ejectedShare(phase), filled = atrialShare(phase);
  HeartState state;
  state.lv_volume_ml = 120 - 72 * ejected;
  state.rv_volume_ml = 122 - 72 * ejected;
  state.la_volume_ml = 34 + 26 * filled;
  state.ra_volume_ml = 34 + 26 * filled;
  state.contraction = ejected;
  state.mitral_opening = leafletOpening(phase);
  state.tricuspid_opening = leafletOpening(phase);
  return state;
}

}  // namespace echocine::beating_heart
