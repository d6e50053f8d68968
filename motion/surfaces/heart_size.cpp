#include "motion/surfaces/heart_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "motion/mesh/surface_measure.h"
#include "scene/names.h"

namespace echocine {

namespace {

// Our choice, wide: an adult's left ventricle has 46 to 150 mL (Lang et al., J. Am. Soc.
// Echocardiogr. 28, 1-39, 2015), a newborn's a few, a dilated one several hundred.
struct Size {
  Role role;
  double least_ml, most_ml, usual_ml;
};
constexpr Size kSizes[] = {{Role::lv_cavity, 0.5, 1000, 110},
                           {Role::rv_cavity, 0.5, 1000, 120},
                           {Role::la, 0.2, 2000, 50},
                           {Role::ra, 0.2, 2000, 50},
                           {Role::lv_wall, 1, 3000, 240}};
// A unit that brings the volume within this factor of the usual one is suggested; the volumes of
// two units differ by 1000.
constexpr double kFits = 10;

double largestVolume_ml(const ControlMotion& control) {
  double most_m3 = 0;
  for (std::size_t k = 0; k < control.weights.keyframeCount(); ++k)
    most_m3 = std::max(most_m3, std::abs(enclosedVolume(control.triangles, control.rows_m[k])));
  return millilitresFromCubicMetres(most_m3);
}

std::string remedy(const MotionSettings& motion, double ml, double usual_ml) {
  const std::pair<const char*, double> units[] = {{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1.0}};
  for (const auto& unit : units) {
    const double then_ml = ml * std::pow(unit.second / motion.mesh_unit_m, 3);
    if (then_ml > usual_ml / kFits && then_ml < usual_ml * kFits)
      return fmt::format("motion.mesh_unit = \"{}\" makes it {:.3g} mL", unit.first, then_ml);
  }
  const double scale = motion.mesh_scale * std::cbrt(usual_ml / ml);
  return fmt::format("motion.mesh_scale = {:.2g} makes it {:.3g} mL or so", scale, usual_ml);
}

}  // namespace

std::vector<std::string> sizeWarnings(const Scene& scene, const MeshMotion& motion) {
  for (const Size& size : kSizes) {
    const auto id = structureOf(scene, size.role);
    if (!id || motion.surfaces()[index(*id)].membrane) continue;
    const Structure& structure = scene.structures[index(*id)];
    const double ml = largestVolume_ml(motion.control(*id));
    if (!(ml > 0) || (ml >= size.least_ml && ml <= size.most_ml)) continue;
    return {atPlace(structure.place,
                    fmt::format("{}: encloses {:.3g} mL, but a heart's {} {:g} to {:g} mL: {}",
                                structure.name, ml, nameOf(size.role), size.least_ml, size.most_ml,
                                remedy(scene.motion, ml, size.usual_ml)))};
  }
  return {};
}

}  // namespace echocine
