// A frame's surfaces, and its rays through them.

#include "frame/simulator.h"

namespace echocine {

WorkCounts Simulator::traceRays(const PlaneSlice& slice, int /*frame*/, const Group* group,
                                Workspace& w) const {
  const NeededSamples* needed = group ? &group->traced : nullptr;
  if (w.sides)
    return traceThick(slice, *w.sides, scene_.probe, settings_, request_, w.polar, w.side, needed);
  return traceFrame(slice, scene_.probe, settings_, request_, w.polar, needed);
}

WorkCounts Simulator::traceRays(const FrameGeometry& geometry, int frame, const Group* group,
                                Workspace& w) const {
  if (beams_)
    return traceBeams(geometry, scene_.probe, settings_, request_, *beams_, frame,
                      group ? group->beams : all_lines_, w.polar);
  return traceFrame(geometry, scene_.probe, settings_, request_, w.polar,
                    group ? &group->traced : nullptr);
}

void Simulator::stand(const FrameTime& time, Workspace& w) const {
  w.phase = -1;
  clock_.time(Stage::motion,
              [&] { motion_->frameAt(time.phase, w.surfaces, plan_.smooth_normals); });
  clock_.time(Stage::geometry, [&] {
    if (trabeculae_) trabeculae_->raise(w.surfaces, w.smooth);
    std::visit([&](auto& g) { g.update(w.surfaces); }, w.geometry);
    if (w.sides) w.sides->update(w.surfaces);
    if (trabeculae_) trabeculae_->lower(w.surfaces, w.smooth);
  });
  w.phase = time.phase;
}

WorkCounts Simulator::traceAt(const FrameTime& time, const Group* group, Workspace& w) const {
  return std::visit(
      [&](const auto& geometry) {
        return clock_.time(Stage::trace, [&] { return traceRays(geometry, time.frame, group, w); });
      },
      w.geometry);
}

}  // namespace echocine
