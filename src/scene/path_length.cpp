#include "scene/path_length.h"

#include <algorithm>

namespace echocine {

double longestPath(const Scene& scene) {
  double fastest = kScannerSpeed;
  if (scene.effects.travel_time == Switch::on)
    for (const Medium& medium : scene.media) fastest = std::max(fastest, medium.sound_speed_m_s);
  return scene.probe.max_depth_m * fastest / kScannerSpeed;
}

}  // namespace echocine
