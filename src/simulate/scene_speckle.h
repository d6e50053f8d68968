#pragma once
// The speckle of a scene's frames: scatterers, and the tissue that carries them.

#include "core/beam_plane.h"
#include "motion/cycle/cardiac_clock.h"
#include "scene/effect_plan.h"
#include "speckle/field_material.h"
#include "speckle/speckle.h"

namespace echocine {

class SceneSpeckle {
 public:
  SceneSpeckle(const Scene& scene, const MeshMotion& motion, const EffectPlan& plan);

  // Intensities after the average over the beam, in place. Thread-safe; frames of equal time are
  // equal.
  void apply(const FrameTime& time, Intensities& intensities) const;

  std::size_t scatterers() const { return speckle_.scatterers(); }

 private:
  FieldMaterial material_;
  Speckle speckle_;
  std::pair<float, float> y_range_m_;  // of the tissue that beams may see
};

}  // namespace echocine
