#pragma once
// Which effects a loop needs, decided once before its first frame, each with its reason.

#include <string>
#include <vector>

#include "scene/scene.h"

namespace echocine {

struct EffectDecision {
  std::string name;
  bool on = false;
  std::string reason;
};

struct EffectPlan {
  bool reflection = true;
  bool transmission_loss = true;
  bool refraction = true;
  bool attenuation = true;   // the exponent A is computed
  bool backscatter = true;
  bool travel_time = false;
  std::vector<EffectDecision> decisions;
};

EffectPlan planEffects(const Scene& scene);

// Is the channel among those that the scene asks for?
bool wants(const Scene& scene, Channel channel);

}  // namespace echocine
