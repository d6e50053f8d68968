#include "simulate/frame_maker.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/units.h"
#include "output/polar_plane.h"

namespace echocine {

std::vector<ChannelPlane> channelPlanes(const OutputSettings& output, const PolarFrame& polar) {
  std::vector<ChannelPlane> planes;
  for (const Channel channel : output.channels) {
    if (channel == Channel::medium)
      planes.push_back({channel, {}, polar.medium});
    else if (channel == Channel::display)
      planes.push_back({channel, polar.signal, {}});
    else
      planes.push_back({channel, polar.planes.at(channel), {}});
  }
  return planes;
}

FrameMaker::FrameMaker(const Scene& scene, const LoopPlan& plan, const MeshMotion& motion)
    : scene_(scene),
      plan_(plan),
      motion_(motion),
      chain_(scene, plan.effects),
      settings_(scene, plan.effects, plan.cell_echoes),
      request_(planeRequest(scene, plan.effects)) {
  if (plan.effects.rays_per_beam > 1)
    beams_.emplace(scene.probe, beamSpread(plan.effects, scene.acquisition.seed));
}

std::shared_ptr<Workspace> FrameMaker::workspace() {
  std::unique_ptr<Workspace> space;
  {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      space = std::move(free_.back());
      free_.pop_back();
    }
  }
  if (!space && plan_.slice)
    space = std::make_unique<Workspace>(
        Workspace{{}, PlaneSlice(motion_.surfaces(), scene_.probe, plan_.left_out), {}});
  if (!space)
    space = std::make_unique<Workspace>(
        Workspace{{}, FrameGeometry(motion_.surfaces(), plan_.left_out), {}});
  return {space.release(), [this](Workspace* used) {
            const std::lock_guard lock(mutex_);
            free_.emplace_back(used);
          }};
}

Volumes FrameMaker::volumes(const SurfaceFrame& surfaces) const {
  Volumes volumes;
  for (const SurfaceTopology& surface : motion_.surfaces()) {
    if (surface.membrane) continue;
    volumes.emplace_back(scene_.structures[index(surface.id)].name,
                         millilitresFromCubicMetres(motion_.volumeIn(surfaces, surface)));
  }
  return volumes;
}

namespace {

// The intensity stack refuses what cannot be shown by itself; a run without one must not draw it
// either.
void refuseUnusable(double phase, const PolarFrame& polar) {
  const std::optional<std::size_t> bad = firstUnusable(polar.signal);
  if (!bad) return;
  const auto per_line = static_cast<std::size_t>(polar.samples);
  throw JobError(
      fmt::format("phase {}, line {}, sample {}: the intensity after time gain is {}: only finite "
                  "values from 0 up are accepted",
                  phase, *bad / per_line, *bad % per_line, polar.signal[*bad]));
}

}  // namespace

WorkCounts FrameMaker::traceRays(const PlaneSlice& slice, int /*frame*/, PolarFrame& polar) const {
  return traceFrame(slice, scene_.probe, settings_, request_, polar);
}

WorkCounts FrameMaker::traceRays(const FrameGeometry& geometry, int frame,
                                 PolarFrame& polar) const {
  if (beams_) return traceBeams(geometry, scene_.probe, settings_, request_, *beams_, frame, polar);
  return traceFrame(geometry, scene_.probe, settings_, request_, polar);
}

Volumes FrameMaker::trace(const FrameTime& time, Workspace& w) {
  Volumes volumes_ml = traceLines(time, w);
  process(time, w);
  return volumes_ml;
}

Volumes FrameMaker::traceLines(const FrameTime& time, Workspace& w) {
  Volumes volumes_ml;
  clock_.time(Stage::motion, [&] {
    motion_.frameAt(time.phase, w.surfaces, plan_.smooth_normals);
    volumes_ml = volumes(w.surfaces);
  });
  const WorkCounts work = std::visit(
      [&](auto& geometry) {
        clock_.time(Stage::geometry, [&] { geometry.update(w.surfaces); });
        return clock_.time(Stage::trace, [&] { return traceRays(geometry, time.frame, w.polar); });
      },
      w.geometry);
  const std::lock_guard lock(mutex_);
  work_ += work;
  ++traced_frames_;
  return volumes_ml;
}

void FrameMaker::process(const FrameTime& time, Workspace& w) {
  if (!request_.signal) return;
  clock_.time(Stage::signal, [&] { chain_.process(w.polar); });
  refuseUnusable(time.phase, w.polar);
}

GreyImage& FrameMaker::picture(double reference_intensity, Workspace& w, bool wanted) {
  if (!request_.signal) return w.image;
  clock_.time(Stage::signal, [&] { chain_.compress(w.polar, reference_intensity); });
  if (wanted) clock_.time(Stage::scan_conversion, [&] { chain_.picture(w.polar, w.image); });
  return w.image;
}

WorkCounts FrameMaker::work() const {
  const std::lock_guard lock(mutex_);
  return work_;
}

int FrameMaker::tracedFrames() const {
  const std::lock_guard lock(mutex_);
  return traced_frames_;
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
