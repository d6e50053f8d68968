#pragma once
// Mean velocity of a packet of pulses by autocorrelation (Kasai, Namekawa, Koyano and Omoto, IEEE
// Trans. Sonics Ultrason. 32, 458-464, 1985).
//
//   R0 = sum (|z_n|^2 + |z_(n+1)|^2) / 2      R1 = sum z_n conj(z_(n+1)) (D1) v = -v_N arg(R1) / pi
//   v_N = lambda PRF / 4                              (D2) s^2 = 2 (v_N / pi)^2 (1 - |R1| / R0)
//   (D3)
//
// Symbols: z_n field of pulse n; the sums run over the pairs of successive pulses and over the
// samples of the gate; lambda wavelength, m; PRF pulses a second; v velocity along the line,
// positive towards the probe; v_N Nyquist velocity; s standard deviation of velocities in the gate.
//
// Limits: v lies within -v_N to v_N, and faster tissue appears modulo 2 v_N. (D3) holds for a
// spectrum narrower than v_N.

#include <span>
#include <vector>

#include "doppler/wall_filter.h"
#include "scene/probe.h"

namespace echocine {

// The field of one pulse; line-major planes.
struct PulseField {
  std::vector<float> real, imaginary;
};

// Line-major: m/s, m^2/s^2, and R0 per pair and sample, relative to I_S. Where no echo remains,
// power is 0, and velocity and variance are NaN.
struct VelocityPlanes {
  std::vector<float> velocity_m_s, variance_m2_s2, power;
};

// m/s, by (D2).
double nyquistVelocity(const Probe& probe, double prf_hz);

// Samples to either side of a gate's middle sample.
int gateReach(const Probe& probe, double gate_m);

// Precondition: at least two pulses, as many as the filter's, of the probe's lines and samples.
// Uses the threads of the enclosing withThreads(); the result does not depend on their number.
VelocityPlanes estimateVelocity(std::span<const PulseField> pulses, const WallFilter& filter,
                                const Probe& probe, double prf_hz, double gate_m);

}  // namespace echocine
