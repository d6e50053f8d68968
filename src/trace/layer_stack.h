#pragma once
// A plane wave on a stack of plane layers: what it sends back and what passes it twice.
//
// In each medium, with the tangential slowness s = sin(theta_0) / c_0 of the first one,
//   cos theta = sqrt(1 - (c s)^2),  Y = cos theta / Z,  E = exp(2 pi i f h cos theta / c).
// Beyond a fast layer's critical angle cos theta is imaginary: E falls exponentially with the
// thickness h, and a thin enough layer lets the wave through. From the last face to the first,
//   r = (Y_1 - Y_2) / (Y_1 + Y_2),  G' = r + (1 - r^2) G E^2 / (1 + kept r G E^2),
//   t' = (1 + r) t E / (1 + kept r G E^2),
// where G and t are the amplitudes reflected and transmitted by what lies behind the layer. With
// kept = 1 this is the exact recursion, the same as the product of the layers' transfer matrices
// (Brekhovskikh, Waves in Layered Media). With kept = 0 nothing turns back twice inside a layer,
// which is the ray rule for faces further apart than the pulse is long.
//
// Both |G|^2 and the square of the transmitted share of energy are averaged over the power spectrum
// of the pulse, a gated sine of N cycles: in units of the centre frequency
//   W(f) = sin^2(pi N f) / (f^2 - 1)^2, of half-integer N with cos^2,
// whose transform is pulseCorrelation(). So coherence goes with the delay 2 h cos(theta) / c.

#include <span>

namespace echocine {

struct LayerMedium {
  double Z = 0;  // impedance, kg/(m^2 s)
  double c = 0;  // sound speed, m/s
};

struct Layer {
  LayerMedium medium;
  double thickness_m = 0;
  double kept = 1;  // share of what turns back again inside it that still counts
};

struct StackResponse {
  double reflected = 0;     // of the pulse's energy, 0..1
  double passed_twice = 1;  // the same, forward and back
};

// cos^2 of the angle in a medium of speed c; negative beyond the critical angle.
double cosineSquare(double cos_0, double c_0, double c);

// N as the spectrum takes it: the nearest whole number of half cycles, one at least. Such a gated
// sine starts and ends at zero.
double wholeHalfCycles(double pulse_cycles);

// Preconditions: cos_0 in 0..1; at most 8 layers.
StackResponse stackResponse(LayerMedium before, double cos_0, std::span<const Layer> layers,
                            LayerMedium after, double frequency_hz, double pulse_cycles);

}  // namespace echocine
