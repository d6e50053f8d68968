#pragma once
// The plan of a loop, effects and tracer: the record that the program follows, prints and keeps.

#include <string>
#include <vector>

#include "core/ids.h"
#include "plan/effect_plan.h"

namespace echocine {

// A structure, or "interface A/B" of two media, that is omitted.
struct Omission {
  std::string name, reason;
};

struct LoopPlan {
  EffectPlan effects;
  std::vector<Omission> interfaces;
  SurfaceSet left_out;  // those structures
  bool slice = false;   // plane slice; false: Embree
  std::string tracer_reason;
  bool cell_echoes = false;
  bool smooth_normals = false;  // angles of incidence from normals of the limit surface
  std::string echo_reason;
  std::size_t triangles_given = 0;  // of all structures
  std::size_t triangles_kept = 0;   // of the structures that stay
  std::size_t triangles_met = 0;    // cut by the imaging plane, maximum over the frames examined
  std::vector<std::string> warnings;

  const char* tracerName() const { return slice ? "slice" : "embree"; }
};

}  // namespace echocine
