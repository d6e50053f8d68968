#include "frame/frame_rays.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/units.h"
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

// Fibres of a ring, evenly spread over its section: a spiral of equal areas.
constexpr std::size_t kFibres = 19;
struct Fibre {
  float a, b;
};
const std::array<Fibre, kFibres>& fibresOfRing() {
  static const std::array<Fibre, kFibres> fibres = [] {
    std::array<Fibre, kFibres> made{};
    const double golden_rad = std::numbers::pi * (3 - std::sqrt(5.0));
    for (std::size_t i = 0; i < kFibres; ++i) {
      const double out = std::sqrt((static_cast<double>(i) + 0.5) / kFibres),
                   turn_rad = golden_rad * static_cast<double>(i);
      made[i] = {static_cast<float>(out * std::cos(turn_rad)),
                 static_cast<float>(out * std::sin(turn_rad))};
    }
    return made;
  }();
  return fibres;
}

}  // namespace

FrameRays::FrameRays(const Scene& scene, const LoopPlan& plan, const ValveParts& valves)
    : probe_(scene.probe),
      settings_(settingsOf(scene, plan, valves.leaflets.get())),
      request_(planeRequest(scene, plan.effects)),
      valves_(valves),
      chordae_m_(scene.leaflets.chordae_m),
      ring_backscatter_(intensityFromDecibels(scene.leaflets.annulus_db)) {
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
  valves_.chordae->at(w.surfaces, points_m);
  strands.clear();
  for (const Chordae::Chord& chord : valves_.chordae->chords())
    strands.push_back(
        {std::span(points_m).subspan(strands.size() * Chordae::kPoints, Chordae::kPoints),
         settings_.surfaces[index(chord.leaflet)].medium});
  addStrands(strands, chordae_m_, probe_, settings_, request_.intensity_terms, w.polar);
}

// Together the fibres of a ring have its section. Each follows the ring.
void FrameRays::addRings(Workspace& w) const {
  thread_local std::vector<ValveRings::Section> sections;
  thread_local std::vector<Vec3f> points_m;
  thread_local std::vector<Strand> strands;
  valves_.rings->at(w.surfaces, sections);
  points_m.clear();
  strands.clear();
  if (sections.empty()) return;
  for (const ValveRings::Stretch& stretch : valves_.rings->stretches())
    for (const Fibre& fibre : fibresOfRing())
      for (const std::uint32_t end : {stretch.from, stretch.to})
        points_m.push_back(valves_.rings->place(sections[end], fibre.a, fibre.b));
  for (std::size_t i = 0; i < points_m.size(); i += 2)
    strands.push_back(
        {std::span(points_m).subspan(i, 2),
         settings_.surfaces[index(valves_.rings->stretches()[i / (2 * kFibres)].leaflet)].medium,
         ring_backscatter_});
  addStrands(strands, 2 * valves_.rings->radius() / std::sqrt(static_cast<double>(kFibres)), probe_,
             settings_, request_.intensity_terms, w.polar);
}

WorkCounts FrameRays::trace(int frame, const RollingLines::Group* group, Workspace& w) const {
  const WorkCounts work = std::visit(
      [&](const auto& geometry) { return through(geometry, frame, group, w); }, w.geometry);
  if (valves_.chordae) addChordae(w);
  if (valves_.rings) addRings(w);
  return work;
}

}  // namespace echocine
