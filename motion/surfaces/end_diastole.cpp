#include "motion/surfaces/end_diastole.h"

#include <cmath>

namespace echocine {

std::optional<SurfaceId> ventricleOf(const Scene& scene) {
  const auto cavity = structureOf(scene, Role::lv_cavity);
  return cavity ? cavity : structureOf(scene, Role::lv_wall);
}

std::size_t largestKeyframe(std::size_t keyframes,
                            const std::function<double(std::size_t)>& volumeOf) {
  std::size_t largest = 0;
  double most = 0;
  for (std::size_t k = 0; k < keyframes; ++k)
    if (const double volume = std::abs(volumeOf(k)); volume > most) {
      most = volume;
      largest = k;
    }
  return largest;
}

std::size_t nearestKeyframe(double phase, std::span<const double> phases) {
  std::size_t nearest = 0;
  const auto apart = [&](std::size_t k) { return std::abs(std::remainder(phases[k] - phase, 1)); };
  for (std::size_t k = 1; k < phases.size(); ++k)
    if (apart(k) < apart(nearest)) nearest = k;
  return nearest;
}

}  // namespace echocine
