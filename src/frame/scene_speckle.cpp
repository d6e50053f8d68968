#include "frame/scene_speckle.h"

#include <algorithm>

namespace echocine {

SceneSpeckle::SceneSpeckle(const Scene& scene, std::shared_ptr<const Tissue> tissue,
                           std::shared_ptr<const Scatterers> drawn)
    : tissue_(std::move(tissue)),
      speckle_(scene.probe, PointSpread(scene), scene.speckle, tissue_->material, std::move(drawn)),
      seed_(scene.speckle.seed),
      heterogeneity_seed_(scene.speckle.heterogeneity_seed) {
  const auto half_m = static_cast<float>(speckle_.farthestAcross_m());
  about_plane_.assign(tissue_->field->groupCount(), std::pair(-half_m, half_m));
}

SceneSpeckle::SceneSpeckle(const Scene& scene, const MeshMotion& motion,
                           const SharedMotionField& field, const EffectPlan& plan,
                           const Trabeculae* trabeculae, const ValveParts& valves)
    : SceneSpeckle(scene,
                   std::shared_ptr<const Tissue>(
                       new Tissue{field.shared(),
                                  {scene, motion, &plan, trabeculae, &field},
                                  {scene, motion, field.field().referencePhase(), valves}}),
                   nullptr) {}

SceneSpeckle::SceneSpeckle(const Scene& scene, const SceneSpeckle& source)
    : SceneSpeckle(scene, source.tissue_, source.speckle_.drawn()) {}

bool SceneSpeckle::hasSeedsOf(const Scene& scene) const {
  return seed_ == scene.speckle.seed && heterogeneity_seed_ == scene.speckle.heterogeneity_seed;
}

void SceneSpeckle::apply(const FrameTime& time, const SurfaceFrame& surfaces,
                         Intensities& intensities, const CoherentEchoes& echoes, LineRange lines,
                         EchoField& field) const {
  thread_local std::vector<Vec3f> on_sheets_m;
  tissue_->sheets.at(surfaces, on_sheets_m);
  thread_local FieldFrame frame;
  tissue_->field->at(time.phase, frame, about_plane_);
  speckle_.apply(FieldMaterialFrame(frame, on_sheets_m), time.time_s, intensities, echoes, lines,
                 &field);
}

}  // namespace echocine
