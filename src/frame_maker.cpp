#include "frame_maker.h"

#include "core/units.h"

namespace echocine {

std::array<double, kStages> StageClock::milliseconds() const {
  std::array<double, kStages> ms{};
  for (std::size_t s = 0; s < kStages; ++s) ms[s] = static_cast<double>(ns_[s].load()) * 1e-6;
  return ms;
}

FrameMaker::FrameMaker(const Scene& scene, const EffectPlan& plan, const HeartMotion& motion)
    : scene_(scene),
      motion_(motion),
      chain_(scene),
      settings_(scene, plan),
      request_(planeRequest(scene, plan)) {}

std::shared_ptr<Workspace> FrameMaker::workspace() {
  std::unique_ptr<Workspace> space;
  {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      space = std::move(free_.back());
      free_.pop_back();
    }
  }
  if (!space) space = std::make_unique<Workspace>(motion_);
  return {space.release(), [this](Workspace* used) {
            const std::lock_guard lock(mutex_);
            free_.emplace_back(used);
          }};
}

Volumes FrameMaker::volumes(const SurfaceFrame& surfaces) const {
  Volumes volumes;
  for (const SurfaceTopology& surface : motion_.surfaces()) {
    if (surface.membrane) continue;
    const std::size_t s = index(surface.id);
    volumes.emplace_back(scene_.structures[s].name, millilitresFromCubicMetres(enclosedVolume(
                                                        surface, surfaces.positions_m[s])));
  }
  return volumes;
}

Volumes FrameMaker::trace(double phase, Workspace& w) {
  Volumes volumes_ml;
  clock_.time(Stage::motion, [&] {
    motion_.frameAt(phase, w.surfaces);
    volumes_ml = volumes(w.surfaces);
  });
  clock_.time(Stage::geometry, [&] { w.geometry.update(w.surfaces); });
  WorkCounts work = clock_.time(Stage::trace, [&] {
    return traceFrame(w.geometry, scene_.probe, settings_, request_, w.polar);
  });
  work.bvh_updates = 1;
  if (request_.signal) clock_.time(Stage::signal, [&] { chain_.process(w.polar, w.scratch); });
  const std::lock_guard lock(mutex_);
  work_ += work;
  return volumes_ml;
}

GreyImage FrameMaker::picture(double reference_intensity, Workspace& w, bool wanted) {
  GreyImage image;
  if (!request_.signal) return image;
  clock_.time(Stage::signal, [&] { chain_.compress(w.polar, reference_intensity); });
  if (wanted) clock_.time(Stage::scan_conversion, [&] { chain_.picture(w.polar, image); });
  return image;
}

WorkCounts FrameMaker::work() const {
  const std::lock_guard lock(mutex_);
  return work_;
}

std::vector<KeyframeVolume> FrameMaker::keyframeVolumes() const {
  std::vector<KeyframeVolume> list;
  std::map<double, Volumes> by_phase;  // structures mostly share their phases
  SurfaceFrame surfaces;
  for (const Structure& structure : scene_.structures) {
    if (structure.membrane) continue;
    for (const Keyframe& keyframe : structure.keyframes) {
      Volumes& all = by_phase[keyframe.phase];
      if (all.empty()) {
        motion_.frameAt(keyframe.phase, surfaces);
        all = volumes(surfaces);
      }
      for (const auto& [name, ml] : all)
        if (name == structure.name) list.push_back({name, keyframe.phase, ml});
    }
  }
  return list;
}

}  // namespace echocine
