#include "motion/ecg.h"

#include <array>
#include <cmath>
#include <numbers>

namespace echocine {

namespace {

// One wave of the trace: where it stands on the cycle, how strongly it pulls, how wide it is.
struct Wave {
  double angle_rad;  // theta_i
  double strength;   // a_i
  double width_rad;  // b_i
};

// P, Q, R, S, T after McSharry, Clifford, Tarassenko, Smith, "A dynamical model for generating
// synthetic electrocardiogram signals", IEEE Trans. Biomed. Eng. 50(3), 289-294, 2003, Table I.
constexpr std::array<Wave, 5> kWaves{{{-std::numbers::pi / 3, 1.2, 0.25},
                                      {-std::numbers::pi / 12, -5.0, 0.1},
                                      {0, 30.0, 0.1},
                                      {std::numbers::pi / 12, -7.5, 0.1},
                                      {std::numbers::pi / 2, 0.75, 0.4}}};

// Their dz/dt = -sum a_i dtheta_i exp(-dtheta_i^2 / 2 b_i^2), integrated along a cycle of constant
// speed without baseline wander: z ~ sum a_i b_i^2 exp(-dtheta_i^2 / 2 b_i^2).
double trace(double angle_rad) {
  double sum = 0;
  for (const Wave& wave : kWaves) {
    const double distance = std::remainder(angle_rad - wave.angle_rad, 2 * std::numbers::pi);
    const double scaled = distance / wave.width_rad;
    sum += wave.strength * wave.width_rad * wave.width_rad * std::exp(-0.5 * scaled * scaled);
  }
  return sum;
}

}  // namespace

double ecgAmplitude(double phase) {
  return trace(2 * std::numbers::pi * phase) / trace(0);
}

}  // namespace echocine
