#pragma once
// What the surfaces of a scene enclose.

#include <string>
#include <utility>
#include <vector>

namespace echocine {

// Closed structures' volumes in the order of the scene; membranes are left out.
using Volumes = std::vector<std::pair<std::string, double>>;  // mL

struct KeyframeVolume {
  std::string structure;
  double phase = 0, volume_ml = 0;
};

}  // namespace echocine
