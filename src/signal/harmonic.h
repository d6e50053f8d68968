#pragma once
// Second-harmonic imaging, quasi-linear: the echo at the centre frequency f comes from the square
// of a wave sent at f/2. It builds up on its way. Along a ray tube of width w the harmonic power
// grows with the square of the sum of 1/w (Prieur et al., J. Acoust. Soc. Am. 131, 4365-4375, 2012,
// use the same quasi-linear source):
//
//   B(z) = (I(z) / I(F))^2                                                                   (H1)
//   I(z) = asinh(a) - asinh(a (1 - z/F)),  the integral of 1/w from 0 to z, times a constant  (H2)
//   w(z) = hypot(w_F, 0.45 D (1 - z/F)),  w_F = 1.27 lambda F / D,  a = 0.45 D / w_F           (H3)
//
// Symbols: z path length; F transmit focus; D aperture; lambda wavelength of the sent wave. The
// factors of (H3) fit a linear array simulator. For a -> 0 the beam is a plane wave and B =
// (z/F)^2. Attenuation is that of the fundamental at f: the square of a wave at f/2 loses 2
// alpha(f/2), which is alpha(f) if alpha is proportional to the frequency.
//
// Limits: the tube narrows equally across both axes; power lost by the fundamental is left out.

#include <vector>

#include "scene/probe.h"

namespace echocine {

// B of (H1); 1 at the focus. Precondition: path_m >= 0.
double harmonicBuildUp(const Probe& probe, double path_m);

// Gain by which the examiner evens the build-up at each sample: 1/B, at most 12 dB, so that only
// the first centimetres stay dark. Our choice.
std::vector<float> gainsOfBuildUp(const Probe& probe);

// B at each sample.
std::vector<float> buildUps(const Probe& probe);

}  // namespace echocine
