#include "trace/sound_path_tracer.h"

#include "trace/trace_frame.h"

namespace echocine {

namespace {

void put(const LineTrace& trace, Vec3d origin, SoundPath& path) {
  path = {};
  path.inside = trace.inside;
  path.knots.push_back({0, origin});
  for (const InterfaceHit& hit : trace.hits) {
    path.walls.push_back({hit.surface, hit.entering, hit.depth_m});
    if (hit.depth_m > path.knots.back().depth_m) path.knots.push_back({hit.depth_m, hit.point});
  }
  if (const double end_m = trace.segments.back().end_depth_m; end_m > path.knots.back().depth_m)
    path.knots.push_back({end_m, trace.end_m});
  for (const MediumSegment& segment : trace.segments)
    path.stretches.push_back({segment.end_depth_m, segment.structure});
}

}  // namespace

TraceSettings soundPathSettings(const Scene& scene, const EffectPlan& plan) {
  TraceSettings settings(scene, plan);
  settings.reflection = settings.transmission_loss = settings.thin_layers = false;
  settings.attenuation = settings.backscatter = settings.snell_angles = false;
  settings.note_hits = settings.beyond_mirrors = true;
  return settings;
}

void traceSoundPaths(const FrameGeometry& geometry, const TraceSettings& settings,
                     SoundPaths& into) {
  thread_local std::vector<LineTrace> traces;
  walkLines(geometry, into.probe, settings, traces);
  into.paths.resize(traces.size());
  for (std::size_t i = 0; i < traces.size(); ++i)
    put(traces[i], lineGeometry(into.probe, static_cast<int>(i)).origin, into.paths[i]);
}

}  // namespace echocine
