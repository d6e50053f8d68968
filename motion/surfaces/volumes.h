#pragma once
// Volumes of the surfaces of a scene.

#include <string>
#include <utility>
#include <vector>

namespace echocine {

// Volumes of closed structures in the scene's order; membranes are omitted.
using Volumes = std::vector<std::pair<std::string, double>>;  // mL

struct KeyframeVolume {
  std::string structure;
  double phase = 0, volume_ml = 0;
};

}  // namespace echocine
