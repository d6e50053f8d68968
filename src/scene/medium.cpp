#include "scene/medium.h"

#include <cmath>
#include <numbers>

#include "core/units.h"
#include "scene/backscatter_law.h"

namespace echocine {

namespace {

// eta_b of each kind; omega is 2 pi f and k the wave number in the medium.
struct BackscatterCoefficient {
  double omega, k;

  double operator()(const NoBackscatter&) const { return 0; }
  double operator()(const FixedBackscatter& fixed) const { return fixed.per_m_sr; }
  double operator()(const BloodBackscatter& blood) const {
    const double a = blood.cell_radius_m;
    const double V = 4.0 / 3.0 * std::numbers::pi * a * a * a;
    const double sigma_b = particleBackscatter(
        // Eq. 5 is of a cell in its fluid, so its wave number is the fluid's: c = 1/sqrt(G rho).
        omega * std::sqrt(blood.plasma_compressibility_per_pa * blood.plasma_density_kg_m3), a,
        blood.cell_compressibility_per_pa, blood.plasma_compressibility_per_pa,
        blood.cell_density_kg_m3, blood.plasma_density_kg_m3);
    return bloodBackscatter(sigma_b, blood.hematocrit, V);
  }
  double operator()(const TissueBackscatter& tissue) const {
    return tissueBackscatter(tissue.velocity_variation, k, tissue.correlation_length_m);
  }
};

}  // namespace

Medium resolveMedium(const MediumSpec& spec, double frequency_hz) {
  const double omega = 2 * std::numbers::pi * frequency_hz;
  return {
      .name = spec.name,
      .impedance_kg_m2_s = spec.density_kg_m3 * spec.sound_speed_m_s,
      .sound_speed_m_s = spec.sound_speed_m_s,
      .attenuation_np_per_m =
          nepersPerMetre(spec.attenuation_db_cm_mhz, spec.attenuation_exponent, frequency_hz),
      .backscatter_per_m_sr =
          std::visit(BackscatterCoefficient{omega, omega / spec.sound_speed_m_s}, spec.backscatter),
      .blood = spec.blood.value_or(std::holds_alternative<BloodBackscatter>(spec.backscatter)),
  };
}

}  // namespace echocine
