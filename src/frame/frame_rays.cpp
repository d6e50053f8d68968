#include "frame/frame_rays.h"

#include "trace/thick_slice.h"
#include "trace/trace_beams.h"

namespace echocine {

namespace {

EchoCells echoCells(const LoopPlan& plan) {
  if (!plan.cell_echoes) return EchoCells::none;
  return plan.slice ? EchoCells::contours : EchoCells::links;
}

}  // namespace

FrameRays::FrameRays(const Scene& scene, const LoopPlan& plan)
    : probe_(scene.probe),
      settings_(scene, plan.effects, echoCells(plan)),
      request_(planeRequest(scene, plan.effects)) {
  if (plan.effects.rays_per_beam > 1)
    beams_.emplace(probe_, beamSpread(plan.effects, scene.acquisition.seed));
}

WorkCounts FrameRays::through(const PlaneSlice& slice, int /*frame*/,
                              const RollingLines::Group* group, Workspace& w) const {
  const NeededSamples* needed = group ? &group->traced : nullptr;
  if (w.sides)
    return traceThick(slice, *w.sides, probe_, settings_, request_, w.polar, w.side, needed);
  return traceFrame(slice, probe_, settings_, request_, w.polar, needed);
}

WorkCounts FrameRays::through(const FrameGeometry& geometry, int frame,
                              const RollingLines::Group* group, Workspace& w) const {
  if (beams_)
    return traceBeams(geometry, probe_, settings_, request_, *beams_, frame,
                      group ? group->beams : LineRange{0, probe_.lines}, w.polar);
  return traceFrame(geometry, probe_, settings_, request_, w.polar,
                    group ? &group->traced : nullptr);
}

WorkCounts FrameRays::trace(int frame, const RollingLines::Group* group, Workspace& w) const {
  return std::visit([&](const auto& geometry) { return through(geometry, frame, group, w); },
                    w.geometry);
}

}  // namespace echocine
