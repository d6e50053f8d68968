#pragma once
// Full width of the focused beam at a depth, across the lines and across the imaging plane.
//
// Symbols: D aperture, F depth of its focus, z depth along the line, lambda wavelength; index e for
// elevation. Each way is a Gaussian in intensity. Its full width w is that at which the far field
// of a uniform aperture has fallen by 6 dB, sinc^2 = 1/4: 1.207 lambda z / D. Widths of diffraction
// and convergence add as squares. Two ways multiply: 1/w^2 = 1/w_t^2 + 1/w_r^2. A closed form of
// our choice, without side lobes. The narrower projection of D for a steered beam is omitted.

#include "scene/probe.h"

namespace echocine {

// Full width at -6 dB / standard deviation of a Gaussian: exp(-(w/2)^2 / (2 sigma^2)) = 1/4.
inline constexpr double kWidthPerDeviation = 3.3302184446307912;  // sqrt(8 ln 4)

// One way through an aperture focused at every depth, as in receive: w_r = 1.207 lambda z / D.
double followedWidth(double depth_m, double aperture_m, double wavelength_m);

// One way through an aperture focused at F: w_t^2 = w_r^2 + (D (1 - z/F))^2.
double focusedWidth(double depth_m, double aperture_m, double focus_m, double wavelength_m);

// Two ways across the lines, receive focused at every depth. At the transmit focus it is the
// diffraction width / sqrt 2.
double focusedBeamWidth(double depth_m, double aperture_m, double focus_m, double wavelength_m);

// Two ways across the imaging plane, through one fixed lens: w_e / sqrt 2.
double elevationBeamWidth(double depth_m, double aperture_m, double focus_m, double wavelength_m);

}  // namespace echocine
