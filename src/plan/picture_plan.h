#pragma once
// The part of the plan that truth knows nothing of: trabeculae, speckle, what tissue it shows, and
// what the scanner adds.

#include "plan/effect_plan.h"

namespace echocine {

// The relief of the ventricles' inner surfaces.
void planTrabeculae(const Scene& scene, EffectPlan& plan);

// Speckle and what scatterers and interfaces have of it. Precondition: plan.contrast,
// plan.backscatter and plan.reflection are decided.
void planSpeckle(const Scene& scene, EffectPlan& plan);

// Drop-out, ribs, haze, reverberation, clutter, noise and persistence.
void planArtefacts(const Scene& scene, EffectPlan& plan);

}  // namespace echocine
