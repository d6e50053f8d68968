#include "plan/media_in_use.h"

#include <algorithm>

namespace echocine {

std::vector<const Medium*> mediaInUse(const Scene& scene) {
  std::vector<const Medium*> used{&scene.medium(scene.background)};
  for (const Structure& s : scene.structures) used.push_back(&scene.medium(s.medium));
  return used;
}

bool mediaDiffer(const Scene& scene) {
  const std::vector<const Medium*> used = mediaInUse(scene);
  return std::any_of(used.begin(), used.end(),
                     [&](const Medium* m) { return !sameMedium(*m, *used[0]); });
}

bool speedsDiffer(const Scene& scene) {
  const std::vector<const Medium*> used = mediaInUse(scene);
  return std::any_of(used.begin(), used.end(), [&](const Medium* m) {
    return m->sound_speed_m_s != used[0]->sound_speed_m_s;
  });
}

bool isAirFilled(const Medium& medium) {
  constexpr double kDensity_kg_m3 = 700;
  return medium.impedance_kg_m2_s < kDensity_kg_m3 * medium.sound_speed_m_s;
}

bool holdsAir(const Scene& scene) {
  const std::vector<const Medium*> used = mediaInUse(scene);
  return std::any_of(used.begin(), used.end(), [](const Medium* m) { return isAirFilled(*m); });
}

}  // namespace echocine
