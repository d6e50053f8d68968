#include "frame/frame_stages.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/usable.h"
#include "frame/loop_instant.h"
#include "frame/structure_volumes.h"

namespace echocine {

namespace {

// The intensity stack refuses what cannot be shown by itself; a run without one must not draw it
// either.
void refuseUnusable(double phase, const PolarFrame& polar) {
  const std::optional<std::size_t> bad = firstUnusable(polar.intensities);
  if (!bad) return;
  const auto per_line = static_cast<std::size_t>(polar.samples);
  throw JobError(
      fmt::format("phase {}, line {}, sample {}: the intensity after time gain is {}: only finite "
                  "values from 0 up are accepted",
                  phase, *bad / per_line, *bad % per_line, polar.intensities[*bad]));
}

}  // namespace

// All stages of a frame, in order: motion, geometry, trace, signal, speckle; then the picture.
Volumes FrameStages::make(const FrameTime& time, const Making& making, Workspace& w) const {
  Volumes volumes_ml;
  if (!making.traced) {
    const bool rolls = effects.rolling && !making.still && !making.lines;
    const LineRange lines = making.lines.value_or(LineRange{0, scene.probe.lines});
    std::optional<LineGroup> some;
    if (making.lines) some = lineGroup(lines, 0, takenBy(lines));
    if (w.polar.intensities.empty()) w.polar.intensities = Intensities(w.greys.release());
    WorkCounts work;
    // Near the probe the average over the beam needs nearly all lines, deeper only a few; haze
    // needs all. Work for a group's lines alone is done for these lines only.
    for (std::size_t g = 0; rolls && g < effects.rolling->groups().size(); ++g) {
      const RollingLines::Group& group = effects.rolling->groups()[g];
      const FrameTime at = instantOf(cardiac_clock, scene, time.time_s + group.offset_s);
      stand(at, w);
      work += clock.time(Stage::trace, [&] { return rays.trace(at.frame, &group, w); });
      process(at, group.lines, making.keeps_field, w);
      effects.rolling->take(g, w.polar, w.rolled);
    }
    if (rolls) std::swap(w.polar, w.rolled);
    stand(time, w);  // of a rolling frame for volumes and truth
    const LineGroup* only = some ? &*some : nullptr;
    if (!rolls) work = clock.time(Stage::trace, [&] { return rays.trace(time.frame, only, w); });
    w.crossings = work.crossings;
    if (making.counted) tally.addFrame(work);
    if (making.received) making.received(w.polar.intensities);
    if (!rolls) process(time, lines, making.keeps_field, w);
    if (rays.receive() && !making.still) refuseUnusable(time.phase, w.polar);
    volumes_ml =
        clock.time(Stage::motion, [&] { return structureVolumes(scene, *motion, w.surfaces); });
  }
  if (!making.white || !rays.receive()) return volumes_ml;
  clock.time(Stage::signal, [&] {
    w.greys =
        chain.compress(std::move(w.polar.intensities), *making.white, time.time_s, w.polar.field);
  });
  if (effects.persistence && making.persists)
    effects.persistence->apply(*making.white, time, w.greys, [&](const FrameTime& earlier) {
      return withoutPersistence(*making.white, earlier);
    });
  if (making.picture) clock.time(Stage::scan_conversion, [&] { chain.picture(w.greys, w.image); });
  return volumes_ml;
}

// The samples of each line that some lines need.
std::vector<int> FrameStages::takenBy(LineRange lines) const {
  return chain.taken(effects.speckle ? effects.speckle->reach(lines) : lines);
}

// The surfaces of an instant, made ready for rays.
void FrameStages::stand(const FrameTime& time, Workspace& w) const {
  w.phase = -1;
  clock.time(Stage::motion, [&] { motion->frameAt(time.phase, w.surfaces, plan.smooth_normals); });
  clock.time(Stage::geometry, [&] {
    if (effects.trabeculae) effects.trabeculae->raise(w.surfaces, w.smooth);
    if (valves.leaflets) valves.leaflets->thicken(w.surfaces, w.sheets);
    std::visit([&](auto& g) { g.update(w.surfaces); }, w.geometry);
    if (w.sides) w.sides->update(w.surfaces);
    if (valves.leaflets) valves.leaflets->thin(w.surfaces, w.sheets);
    if (effects.trabeculae) effects.trabeculae->lower(w.surfaces, w.smooth);
  });
  w.phase = time.phase;
}

// Time gain and beam width of some lines, and their speckle.
void FrameStages::process(const FrameTime& time, LineRange lines, bool keeps_field,
                          Workspace& w) const {
  if (!rays.receive()) return;
  PolarFrame& polar = w.polar;
  clock.time(Stage::signal, [&] {
    chain.process(polar.intensities, effects.speckle ? effects.speckle->reach(lines) : lines,
                  polar.medium);
    chain.process(polar.coherent, lines);
  });
  if (!effects.speckle) return;
  if (chain.addsFields() || keeps_field) polar.field.resize(polar.intensities.size());
  clock.time(Stage::speckle, [&] {
    effects.speckle->apply(time, w.surfaces, polar.intensities, polar.coherent, lines, polar.field);
  });
}

// A frame that persists in a later one. It counts as no work of its own: how often it is made
// depends on what is still known.
Greys FrameStages::withoutPersistence(double white_at, const FrameTime& time) const {
  const std::shared_ptr<Workspace> w = workspaces.borrow();
  make(time, {.counted = false, .persists = false, .white = white_at}, *w);
  return std::move(w->greys);
}

namespace {

template <typename Part, typename... Arguments>
std::unique_ptr<const Part> where(bool asked, Arguments&&... arguments) {
  return asked ? std::make_unique<const Part>(std::forward<Arguments>(arguments)...) : nullptr;
}

}  // namespace

FrameEffects::FrameEffects(const Scene& scene, const MeshMotion& motion,
                           const SharedMotionField& field, const LoopPlan& plan,
                           const CardiacClock& clock, const SignalChain& chain,
                           const SceneSpeckle* source, const ValveParts& valves)
    : trabeculae(where<Trabeculae>(plan.effects.trabeculae, scene, motion, !plan.slice)),
      speckle(source && source->hasSeedsOf(scene)
                  ? where<SceneSpeckle>(plan.effects.speckle, scene, *source)
                  : where<SceneSpeckle>(plan.effects.speckle, scene, motion, field, plan.effects,
                                        trabeculae.get(), valves)),
      rolling(where<RollingLines>(
          plan.effects.rolling, scene,
          [&](LineRange lines) { return chain.taken(speckle ? speckle->reach(lines) : lines); })),
      persistence(where<Persistence>(plan.effects.persistence, scene.artefacts.persistence, clock,
                                     scene.acquisition.frame_rate_hz)) {}

FrameStages::FrameStages(Scene given, std::shared_ptr<const MeshMotion> given_motion,
                         LoopPlan given_plan, const SceneSpeckle* source,
                         std::shared_ptr<const SignalChain> given_chain,
                         std::shared_ptr<const MotionField> known_field)
    : scene(std::move(given)),
      motion(std::move(given_motion)),
      plan(std::move(given_plan)),
      cardiac_clock(scene),
      shared_chain(given_chain ? std::move(given_chain)
                               : std::make_shared<const SignalChain>(scene, plan.effects)),
      chain(*shared_chain),
      valves{where<LeafletBodies>(plan.effects.leaflets, scene, *motion),
             where<Chordae>(plan.effects.chordae, scene, *motion),
             where<ValveRings>(plan.effects.annulus, scene, *motion)},
      rays(scene, plan, valves),
      field(scene, *motion, source ? source->field() : std::move(known_field)),
      effects(scene, *motion, field, plan, cardiac_clock, chain, source, valves),
      truth(scene, *motion, field, cardiac_clock, plan, effects.rolling.get(),
            plan.left_out.none() && !effects.trabeculae && !valves.leaflets),
      workspaces(scene, valves.leaflets ? valves.leaflets->surfaces() : motion->surfaces(), plan) {}

}  // namespace echocine
