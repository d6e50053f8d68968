#pragma once
// The speckle of a scene's frames: scatterers and the tissue that moves them.

#include <memory>

#include "core/beam_plane.h"
#include "motion/cycle/cardiac_clock.h"
#include "plan/effect_plan.h"
#include "speckle/field_material.h"
#include "speckle/sheet_points.h"
#include "speckle/speckle.h"

namespace echocine {

class SceneSpeckle {
 public:
  SceneSpeckle(const Scene& scene, const MeshMotion& motion, const SharedMotionField& field,
               const EffectPlan& plan, const Trabeculae* trabeculae, const ValveParts& valves);
  // Shares field and scatterers. Preconditions: `source` is of the same motion, which outlives
  // this, and of a scene that differs at most in lines, samples and what no scatterer depends on.
  SceneSpeckle(const Scene& scene, const SceneSpeckle& source);

  // Whether scatterers and the strength of tissue are drawn from the scene's seeds.
  bool hasSeedsOf(const Scene& scene) const;
  const std::shared_ptr<const MotionField>& field() const { return tissue_->field; }

  // Applies speckle in place to the intensities of some lines after the beam average, and to their
  // coherent part. `surfaces` are those of the instant. field: unless empty, receives the field of
  // these lines. Thread-safe; frames of equal time are equal.
  void apply(const FrameTime& time, const SurfaceFrame& surfaces, Intensities& intensities,
             const CoherentEchoes& echoes, LineRange lines, EchoField& field) const;
  // Lines whose intensities affect those of a range.
  LineRange reach(LineRange lines) const { return speckle_.reach(lines); }

  std::size_t scatterers() const { return speckle_.scatterers() + tissue_->sheets.count(); }

 private:
  // The same for all numbers of lines and samples.
  struct Tissue {
    std::shared_ptr<const MotionField> field;  // referred to by the material
    FieldMaterial material;
    SheetPoints sheets;
  };
  SceneSpeckle(const Scene& scene, std::shared_ptr<const Tissue> tissue,
               std::shared_ptr<const Scatterers> drawn);

  std::shared_ptr<const Tissue> tissue_;
  Speckle speckle_;
  FieldPart about_plane_;  // region of the scatterers
  int seed_, heterogeneity_seed_;
};

}  // namespace echocine
