#pragma once
// The heart at one phase: chambers, walls and leaflets that fit together.

#include <string>
#include <vector>

#include "examples/beating_heart/control_mesh.h"

namespace echocine::beating_heart {

struct Part {
  std::string name;
  std::vector<Vec3d> points_cm;  // on the surface, not yet control points
  std::vector<Face> faces;
};

// Every part at a phase in [0, 1), always in the same order with the same faces.
std::vector<Part> heartAt(double phase);

}  // namespace echocine::beating_heart
