#include "frame/frame_rays.h"

#include <limits>

#include "trace/strand_echoes.h"
#include "trace/thick_slice.h"
#include "trace/trace_beams.h"

namespace echocine {

namespace {

EchoCells echoCells(const LoopPlan& plan) {
  if (!plan.cell_echoes) return EchoCells::none;
  return plan.slice ? EchoCells::contours : EchoCells::links;
}

// Bodies of leaflets pierce all other structures.
TraceSettings settingsOf(const Scene& scene, const LoopPlan& plan, const LeafletBodies* bodies) {
  TraceSettings settings(scene, plan.effects, echoCells(plan));
  for (std::size_t s = 0; bodies && s < settings.surfaces.size(); ++s) {
    if (!bodies->isBody(static_cast<SurfaceId>(s))) continue;
    settings.surfaces[s].membrane = false;
    settings.surfaces[s].priority = std::numeric_limits<int>::max();
  }
  return settings;
}

}  // namespace

FrameRays::FrameRays(const Scene& scene, const LoopPlan& plan, const LeafletBodies* bodies,
                     const Chordae* chordae)
    : probe_(scene.probe),
      settings_(settingsOf(scene, plan, bodies)),
      request_(planeRequest(scene, plan.effects)),
      chordae_(chordae),
      chordae_m_(scene.leaflets.chordae_m) {
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

// Each is of the medium of its leaflet.
void FrameRays::addChordae(Workspace& w) const {
  thread_local std::vector<Vec3f> points_m;
  thread_local std::vector<Strand> strands;
  chordae_->at(w.surfaces, points_m);
  strands.clear();
  for (const Chordae::Chord& chord : chordae_->chords())
    strands.push_back(
        {std::span(points_m).subspan(strands.size() * Chordae::kPoints, Chordae::kPoints),
         settings_.surfaces[index(chord.leaflet)].medium});
  addStrands(strands, chordae_m_, probe_, settings_, request_.intensity_terms, w.polar);
}

WorkCounts FrameRays::trace(int frame, const RollingLines::Group* group, Workspace& w) const {
  const WorkCounts work = std::visit(
      [&](const auto& geometry) { return through(geometry, frame, group, w); }, w.geometry);
  if (chordae_) addChordae(w);
  return work;
}

}  // namespace echocine
