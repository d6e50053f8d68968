#pragma once
// Eqs. 1 and 2 of the paper, Snell's law and the non-specular lobe, as pure functions in the
// paper's symbols. Angles appear only as cosines; cos_i and cos_t are those of incidence and
// transmission, 0..1.

#include <optional>

#include "core/vec3.h"

namespace echocine {

// Snell: sin_t / c_2 = sin_i / c_1. None at and beyond the critical angle (total reflection).
std::optional<double> transmissionCosine(double cos_i, double c_1, double c_2);

// Eq. 1: I_r / I_i of a plane wave. R at normal incidence is ((Z_2 - Z_1) / (Z_2 + Z_1))^2.
double reflectance(double Z_1, double Z_2, double cos_i, double cos_t);

// Eq. 2: I_t / I_i. Energy is conserved as R + T cos_t / cos_i = 1, because the beam changes its
// width. Forward and back, T_12 T_21 = (1 - R)^2, so a two-way loss needs R alone.
double transmittance(double Z_1, double Z_2, double cos_i, double cos_t);

// Section 2.1: I_r = I_i W(theta_i) cos^n(theta_i), the return of a rough interface.
double nonSpecularReturn(double W, double cos_i, double n);

// The interface between two media at cos_i: R, which is 1 under total reflection, and 1 - R. For
// grazing rays the difference 1 - R would be rounding, so it has its own formula.
struct InterfaceLaw {
  double R = 0;          // share of intensity
  double through = 1;    // 1 - R
  bool total = false;    // the ray ends
  double amplitude = 0;  // of the reflected pressure: R with its sign; of a total reflection 1
};
InterfaceLaw interfaceLaw(double Z_1, double c_1, double Z_2, double c_2, double cos_i);

// The part of R that a rough wall returns to the transducer: no more than at normal incidence.
// Specular reflection near the critical angle goes elsewhere and does not return.
double cappedReflectance(double R, double Z_1, double Z_2);

// The transmitted direction in space. normal: unit, either way; direction: unit. None under total
// reflection. c_1 = c_2 leaves the direction unchanged to the last bit.
std::optional<Vec3d> refracted(Vec3d direction, Vec3d normal, double c_1, double c_2);

}  // namespace echocine
