#include "frame/scene_speckle.h"

#include <algorithm>

namespace echocine {

SceneSpeckle::SceneSpeckle(const Scene& scene, const MeshMotion& motion,
                           const SharedMotionField& field, const EffectPlan& plan,
                           const Trabeculae* trabeculae)
    : material_(scene, motion, &plan, trabeculae, &field),
      sheets_(scene, motion, material_.field().referencePhase()),
      speckle_(scene.probe, scene.signal.pulse_cycles, scene.speckle, material_) {
  const auto half_m = static_cast<float>(speckle_.farthestAcross_m());
  about_plane_.assign(material_.field().groupCount(), std::pair(-half_m, half_m));
}

void SceneSpeckle::apply(const FrameTime& time, const SurfaceFrame& surfaces,
                         Intensities& intensities, const CoherentEchoes& echoes, LineRange lines,
                         EchoField& field) const {
  thread_local std::vector<Vec3f> on_sheets_m;
  sheets_.at(surfaces, on_sheets_m);
  thread_local FieldFrame frame;
  material_.field().at(time.phase, frame, about_plane_);
  speckle_.apply(FieldMaterialFrame(frame, on_sheets_m), time.time_s, intensities, echoes, lines,
                 &field);
}

}  // namespace echocine
