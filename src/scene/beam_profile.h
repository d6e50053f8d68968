#pragma once
// How wide the focused beam is at a depth, across the lines and across the imaging plane.
//
// Symbols: D aperture, F depth of its focus, z depth along the line, lambda wavelength; index e for
// the elevation. Each way is a bell (a Gaussian in intensity) whose full width w is measured where
// a uniform aperture's far field has fallen by 6 dB, sinc^2 = 1/4: 1.207 lambda z / D. Diffraction
// and convergence add as squares, and two ways multiply: 1/w^2 = 1/w_t^2 + 1/w_r^2. A closed form
// of our choice, without side lobes; a steered phased array's narrower projection of D is left out.

#include "scene/probe.h"

namespace echocine {

// Full width at -6 dB over the standard deviation of a bell: exp(-(w/2)^2 / (2 sigma^2)) = 1/4.
inline constexpr double kWidthPerDeviation = 3.3302184446307912;  // sqrt(8 ln 4)

// One way through an aperture that is focused at every depth, as receive is:
// w_r = 1.207 lambda z / D.
double followedWidth(double depth_m, double aperture_m, double wavelength_m);

// One way through an aperture focused at F: w_t^2 = w_r^2 + (D (1 - z/F))^2.
double focusedWidth(double depth_m, double aperture_m, double focus_m, double wavelength_m);

// Across the lines, two ways, receive focused at every depth: at the transmit focus it is the
// diffraction width over sqrt 2.
double focusedBeamWidth(double depth_m, double aperture_m, double focus_m, double wavelength_m);

// Across the imaging plane, two ways through one fixed lens: w_e / sqrt 2.
double elevationBeamWidth(double depth_m, double aperture_m, double focus_m, double wavelength_m);

}  // namespace echocine
