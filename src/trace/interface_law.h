#pragma once
// Eqs. 1 and 2 of the paper, Snell's law and the non-specular lobe, as pure functions in the
// paper's symbols. Angles appear only as cosines; cos_i and cos_t are those of incidence and
// transmission, 0..1.

#include <optional>

#include "core/vec3.h"

namespace echocine {

// Snell: sin_t / c_2 = sin_i / c_1. Nothing at and beyond the critical angle (total reflection).
std::optional<double> transmissionCosine(double cos_i, double c_1, double c_2);

// Eq. 1: I_r / I_i of a plane wave. R at normal incidence is ((Z_2 - Z_1) / (Z_2 + Z_1))^2.
double reflectance(double Z_1, double Z_2, double cos_i, double cos_t);

// Eq. 2: I_t / I_i. Energy is conserved as R + T cos_t / cos_i = 1, since the beam changes its
// width; forward and back together T_12 T_21 = (1 - R)^2, so a two-way loss needs R alone.
double transmittance(double Z_1, double Z_2, double cos_i, double cos_t);

// Section 2.1: I_r = I_i W(theta_i) cos^n(theta_i), what a rough interface sends back.
double nonSpecularReturn(double W, double cos_i, double n);

// The interface between two media at cos_i: R, 1 under total reflection, and 1 - R. Grazing rays
// leave nothing of 1 - R but rounding if it is taken as that difference, so it has a formula.
struct InterfaceLaw {
  double R = 0;          // share of intensity
  double through = 1;    // 1 - R
  bool total = false;    // no ray goes on
  double amplitude = 0;  // of the reflected pressure: R with its sign; of a total reflection 1
};
InterfaceLaw interfaceLaw(double Z_1, double c_1, double Z_2, double c_2, double cos_i);

// What of R a rough wall sends back towards the transducer: no more than at normal incidence. What
// a mirror throws elsewhere near the critical angle does not come back.
double cappedReflectance(double R, double Z_1, double Z_2);

// The transmitted direction in space. normal: unit, either way; direction: unit.
// Nothing under total reflection. c_1 = c_2 leaves the direction unchanged to the last bit.
std::optional<Vec3d> refracted(Vec3d direction, Vec3d normal, double c_1, double c_2);

}  // namespace echocine
