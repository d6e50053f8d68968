#pragma once
// The part of the plan that does not affect truth: grey map, trabeculae, speckle and its tissue
// properties, artefacts.

#include "plan/effect_plan.h"

namespace echocine {

// The curve from decibels to grey.
void planGreyMap(const Scene& scene, EffectPlan& plan);
// The relief of the ventricles' inner surfaces.
void planTrabeculae(const Scene& scene, EffectPlan& plan);
// The thickness of leaflets.
void planLeaflets(const Scene& scene, EffectPlan& plan);
// The chordae; the fibrous rings. Precondition: the rays per beam are planned.
void planChordae(const Scene& scene, EffectPlan& plan);
void planAnnulus(const Scene& scene, EffectPlan& plan);

// Speckle and the properties of scatterers and interfaces. Precondition: plan.contrast,
// plan.backscatter and plan.reflection are decided.
void planSpeckle(const Scene& scene, EffectPlan& plan);

// Second harmonic, downshift and receiving aperture. Precondition: plan.beam_width is decided.
void planPulse(const Scene& scene, EffectPlan& plan);

// Drop-out, ribs, haze, reverberation, clutter, noise and persistence.
void planArtefacts(const Scene& scene, EffectPlan& plan);

}  // namespace echocine
