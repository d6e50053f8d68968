#pragma once
// What a loop is going to compute and by which tracer: the record that the program acts on, prints
// and keeps.

#include <string>
#include <vector>

#include "core/ids.h"
#include "plan/effect_plan.h"

namespace echocine {

// A structure, or "interface A/B" of two media, that drops out.
struct Omission {
  std::string name, reason;
};

struct LoopPlan {
  EffectPlan effects;
  std::vector<Omission> interfaces;
  SurfaceSet left_out;  // those structures
  bool slice = false;   // the plane slice traces; else the hierarchy
  std::string tracer_reason;
  bool cell_echoes = false;
  bool smooth_normals = false;  // angles of incidence by the limit surfaces' normals
  std::string echo_reason;
  std::size_t triangles_given = 0;  // of all structures
  std::size_t triangles_kept = 0;   // of the structures that stay
  std::size_t triangles_met = 0;    // cut by the imaging plane, the most of the frames looked at
  std::vector<std::string> warnings;

  const char* tracerName() const { return slice ? "slice" : "embree"; }
};

}  // namespace echocine
