#pragma once
// Losses of a scan line in the patient's chest: lost contact towards the sector's edges, ribs that
// shade part of the aperture, and patches of the chest wall (chest_screen.h).

#include <span>
#include <vector>

#include "plan/effect_plan.h"
#include "scene/scene.h"

namespace echocine {

// Intensity factor of drop-out at s = -1 (first line) to 1 (last): 10^(-L s^4 / 10), L in dB at the
// edges. The fourth power keeps the middle half within L / 16. Our choice.
double dropoutFactor(double s, double loss_db);

// Ribs at one depth d with a gap of width w. The fraction f of an aperture D at the start of a
// line is open: its straight paths to a point pass the gap. Paths through ribs keep the amplitude
// tau. Both ways: (f + (1 - f) tau)^4, with tau^4 the full shadow in intensity. 1 in front of the
// ribs. Points in the probe frame, from the centre of the face; lines of a curved face start behind
// it (start_z < 0).
struct RibGap {
  double aperture_m = 0, width_m = 0, offset_m = 0, depth_m = 0, shadow_db = 0;
  double openPart(double start_x_m, double x_m, double z_m, double start_z_m = 0) const;
  double factor(double start_x_m, double x_m, double z_m, double start_z_m = 0) const;
};

// Factors of all samples, line-major; empty if the plan has none of these effects.
std::vector<float> sectorLosses(const Probe& probe, const ArtefactSettings& settings,
                                const EffectPlan& plan);

// plane[i] *= factors[i]. Precondition: equal sizes.
void applySectorLosses(std::span<const float> factors, std::span<float> plane);

}  // namespace echocine
