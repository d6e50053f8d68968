#pragma once
// Eqs. 5-7 of the paper as pure functions, in SI units.

namespace echocine {

// Eq. 5 at theta = 180 degrees: differential backscattering cross section of one small sphere,
// m^2/sr.
//   k wave number 1/m, a radius m, G_e, G compressibilities and rho_e, rho densities of particle
//   and fluid.
// Limit: k a << 1 (Rayleigh). A particle equal to its fluid does not scatter.
double particleBackscatter(double k, double a, double G_e, double G, double rho_e, double rho);

// Eq. 6: backscattering coefficient of blood, 1/(m sr).
//   sigma_b cross section of one particle m^2/sr, W_0 hematocrit 0..1, V volume of one particle
//   m^3.
// Its packing factor W (1-W)^4 / (1+2W)^2 is 0 at W = 0 and W = 1 and largest at W = 0.13.
double bloodBackscatter(double sigma_b, double W_0, double V);

// Eq. 7: backscattering coefficient of tissue, 1/(m sr).
//   mu root mean square velocity variation, k wave number 1/m, b_m correlation length m.
// For k b_m -> 0 the bracket cancels to (8/3) (k b_m)^3; there its series is summed instead, so
// that the relative error stays below 1e-12 for every k b_m.
double tissueBackscatter(double mu, double k, double b_m);

}  // namespace echocine
