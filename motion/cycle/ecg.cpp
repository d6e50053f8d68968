#include "motion/cycle/ecg.h"

#include <array>
#include <cmath>
#include <numbers>

namespace echocine {

namespace {

// One wave of the trace at 60 beats per minute: time of its peak relative to R, strength, width,
// and the exponents of the beat's duration for its time and width.
struct Wave {
  double angle_rad;  // theta_i
  double strength;   // a_i
  double width_rad;  // b_i
  double time_power, width_power;

  double peak(double beat_s) const {
    return angle_rad / (2 * std::numbers::pi) * std::pow(beat_s, time_power);
  }
  double width(double beat_s) const {
    return width_rad / (2 * std::numbers::pi) * std::pow(beat_s, width_power);
  }
};

// P, Q, R, S, T after McSharry, Clifford, Tarassenko, Smith, "A dynamical model for generating
// synthetic electrocardiogram signals", IEEE Trans. Biomed. Eng. 50(3), 289-294, 2003, Table I.
// They scale widths and angles by sqrt(HR/60). Their program ECGSYN (PhysioNet) scales the P wave's
// angle by the root of that, so P is T^(3/4) before R in a beat of T seconds. For T the factor
// sqrt(HR/60) is Bazett's rule, QT ~ sqrt(RR) (Heart 7, 353-370, 1920). Ventricular activation
// hardly depends on the rate, so Q, R and S keep their times: our choice, as are constant
// amplitudes.
constexpr double kFixed = 0, kRoot = 0.5;
constexpr Wave kP{-std::numbers::pi / 3, 1.2, 0.25, 0.75, kRoot};
constexpr Wave kT{std::numbers::pi / 2, 0.75, 0.4, kRoot, kRoot};
constexpr std::array<Wave, 5> kWaves{{kP,
                                      {-std::numbers::pi / 12, -5.0, 0.1, kFixed, kFixed},
                                      {0, 30.0, 0.1, kFixed, kFixed},
                                      {std::numbers::pi / 12, -7.5, 0.1, kFixed, kFixed},
                                      kT}};

// Their dz/dt = -sum a_i dtheta_i exp(-dtheta_i^2 / 2 b_i^2), integrated along a cycle of constant
// speed without baseline wander: z ~ sum a_i b_i^2 exp(-dtheta_i^2 / 2 b_i^2), here in time. Waves
// of both neighbouring beats are included, so beats join continuously.
double trace(double time_s, double beat_s) {
  double sum = 0;
  for (const Wave& wave : kWaves) {
    const double height = wave.strength * wave.width_rad * wave.width_rad;
    const double peak = wave.peak(beat_s), width = wave.width(beat_s);
    for (int r = -1; r <= 2; ++r) {
      const double scaled = (time_s - r * beat_s - peak) / width;
      sum += height * std::exp(-0.5 * scaled * scaled);
    }
  }
  return sum;
}

}  // namespace

double ecgAmplitude(double time_s, double beat_s) {
  return trace(time_s, beat_s) / trace(0, beat_s);
}

double tPeakAfterR(double beat_s) {
  return kT.peak(beat_s);
}

double pPeakBeforeR(double beat_s) {
  return -kP.peak(beat_s);
}

}  // namespace echocine
