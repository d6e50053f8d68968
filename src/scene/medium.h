#pragma once
// A medium as the tracer uses it: numbers at the frequency of the run. Eqs. 5-7 and the unit
// conversions are evaluated once, when the scene is read.

#include <optional>
#include <string>
#include <variant>

namespace echocine {

// No backscatter.
struct NoBackscatter {};

// A given backscattering coefficient.
struct FixedBackscatter {
  double per_m_sr = 0;  // eta_b
};

// Blood: Eq. 5 for one cell, Eq. 6 for the suspension. Symbols as in the paper.
struct BloodBackscatter {
  double hematocrit = 0;                     // W_0, fraction
  double cell_radius_m = 0;                  // a; the cell's volume V is that of this sphere
  double cell_density_kg_m3 = 0;             // rho_e
  double cell_compressibility_per_pa = 0;    // G_e
  double plasma_density_kg_m3 = 0;           // rho
  double plasma_compressibility_per_pa = 0;  // G
};

// Tissue: Eq. 7. Symbols as in the paper.
struct TissueBackscatter {
  double velocity_variation = 0;    // mu, root mean square of (Delta c / c)
  double correlation_length_m = 0;  // b_m
};

using Backscatter =
    std::variant<NoBackscatter, FixedBackscatter, BloodBackscatter, TissueBackscatter>;

struct MediumSpec {
  std::string name;
  double density_kg_m3 = 0;
  double sound_speed_m_s = 0;
  double attenuation_db_cm_mhz = 0;  // a of alpha = a f^b, amplitude
  double attenuation_exponent = 1;   // b
  Backscatter backscatter;
  std::optional<bool> blood;  // stated; else by the law of the backscatter
};

struct Medium {
  std::string name;
  double impedance_kg_m2_s = 0;     // Z = rho c
  double sound_speed_m_s = 0;       // c
  double attenuation_np_per_m = 0;  // alpha, amplitude
  double backscatter_per_m_sr = 0;  // eta_b
  bool blood = false;               // flows: its scatterers are not bound to walls
};

// Equal impedance and speed: their interface neither reflects nor refracts.
inline bool sameInterface(const Medium& a, const Medium& b) {
  return a.impedance_kg_m2_s == b.impedance_kg_m2_s && a.sound_speed_m_s == b.sound_speed_m_s;
}

// Equal in everything except the name.
inline bool sameMedium(const Medium& a, const Medium& b) {
  return sameInterface(a, b) && a.attenuation_np_per_m == b.attenuation_np_per_m &&
         a.backscatter_per_m_sr == b.backscatter_per_m_sr;
}

// The medium's numbers at one frequency. Precondition: densities, speeds and frequency are
// positive.
Medium resolveMedium(const MediumSpec& spec, double frequency_hz);

}  // namespace echocine
