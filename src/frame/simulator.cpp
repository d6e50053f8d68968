#include "frame/simulator.h"

#include <fmt/format.h>

#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "core/usable.h"
#include "frame/loop_instant.h"
#include "frame/plan_loop.h"
#include "frame/reference_frames.h"
#include "frame/structure_volumes.h"
#include "motion/surfaces/probe_placement.h"
#include "scene/scene_keys.h"

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
Volumes Simulator::make(const FrameTime& time, const Making& making, Workspace& w) const {
  Volumes volumes_ml;
  if (!making.traced) {
    const bool rolls = rolling_ && !making.still;
    if (w.polar.intensities.empty()) w.polar.intensities = Intensities(w.greys.release());
    WorkCounts work;
    // Near the probe the average over the beam takes in nearly all lines, deeper few of them; haze
    // takes in all. What only a group's lines need is done for these alone.
    for (std::size_t g = 0; rolls && g < rolling_->groups().size(); ++g) {
      const RollingLines::Group& group = rolling_->groups()[g];
      const FrameTime at = instantOf(cardiac_clock_, scene_, time.time_s + group.offset_s);
      stand(at, w);
      work += clock_.time(Stage::trace, [&] { return rays_.trace(at.frame, &group, w); });
      process(at, group.lines, w);
      rolling_->take(g, w.polar, w.rolled);
    }
    if (rolls) std::swap(w.polar, w.rolled);
    stand(time, w);  // of a rolling frame for volumes and truth
    if (!rolls)
      work = clock_.time(Stage::trace, [&] { return rays_.trace(time.frame, nullptr, w); });
    if (making.counted) tally_.addFrame(work);
    if (making.received) making.received(w.polar.intensities);
    if (!rolls) process(time, {0, scene_.probe.lines}, w);
    if (rays_.receive() && !making.still) refuseUnusable(time.phase, w.polar);
    volumes_ml =
        clock_.time(Stage::motion, [&] { return structureVolumes(scene_, *motion_, w.surfaces); });
  }
  if (!making.white || !rays_.receive()) return volumes_ml;
  clock_.time(Stage::signal, [&] {
    w.greys =
        chain_.compress(std::move(w.polar.intensities), *making.white, time.time_s, w.polar.field);
  });
  if (persistence_ && making.persists)
    persistence_->apply(*making.white, time, w.greys, [&](const FrameTime& earlier) {
      return withoutPersistence(*making.white, earlier);
    });
  if (making.picture)
    clock_.time(Stage::scan_conversion, [&] { chain_.picture(w.greys, w.image); });
  return volumes_ml;
}

// The surfaces of an instant, made ready for rays.
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

// Time gain and beam width of some lines, and their speckle.
void Simulator::process(const FrameTime& time, LineRange lines, Workspace& w) const {
  if (!rays_.receive()) return;
  PolarFrame& polar = w.polar;
  clock_.time(Stage::signal, [&] {
    chain_.process(polar.intensities, speckle_ ? speckle_->reach(lines) : lines);
    chain_.process(polar.coherent, lines);
  });
  if (!speckle_) return;
  if (chain_.addsFields()) polar.field.resize(polar.intensities.size());
  clock_.time(Stage::speckle, [&] {
    speckle_->apply(time, w.surfaces, polar.intensities, polar.coherent, lines, polar.field);
  });
}

// A frame that persists in a later one. It counts as no work of its own: how often it is made
// depends on what is still known.
Greys Simulator::withoutPersistence(double white, const FrameTime& time) const {
  const std::shared_ptr<Workspace> w = workspace();
  make(time, {.counted = false, .persists = false, .white = white}, *w);
  return std::move(w->greys);
}

Frame Simulator::frame(double time_s) const {
  Frame made;
  frame(time_s, made);
  return made;
}

void Simulator::frame(double time_s, Frame& made) const {
  const double end_s = cardiac_clock_.frameCount() / scene_.acquisition.frame_rate_hz;
  if (!(time_s >= 0 && time_s <= end_s))
    throw SceneError(
        fmt::format("the frame at {} s is not in the loop, accepted: 0 to {:g} s "
                    "(acquisition.beats, acquisition.frame_rate_hz)",
                    time_s, end_s));
  made.time = instantOf(cardiac_clock_, scene_, time_s);
  const double white = referenceIntensity();
  const std::shared_ptr<Workspace> w = workspace();
  inThisThread([&] {
    made.volumes_ml = trace(made.time, *w);
    made.intensities.values.assign(w->polar.intensities.begin(), w->polar.intensities.end());
    picture(white, made.time, *w, wantsPicture(scene_));
    made.truth.reset();
    if (truth() != nullptr) made.truth = truthAt(made.time, w.get());
  });
  made.lines = scene_.probe.lines;
  made.samples = scene_.probe.samples;
  std::swap(made.greys, w->greys);
  std::swap(made.image, w->image);
  std::swap(made.channels, w->polar.planes);
  made.medium.clear();  // white may have had it traced
  if (wants(scene_, Channel::medium)) std::swap(made.medium, w->polar.medium);
}

std::optional<double> Simulator::referenceIntensity(const Monitor& monitor,
                                                    const KeepTraced& keep) const {
  const std::lock_guard lock(white_mutex_);
  // A thread that waits in here takes no work from outside, which might ask for white too.
  if (!white_)
    isolated([&] {
      std::vector<FrameTime> times;
      for (const int i : referenceFrames(cardiac_clock_.frameCount()))
        times.push_back(cardiac_clock_.at(i));
      white_ = measureWhite(*this, times, monitor, keep);
    });
  return white_;
}

double Simulator::referenceIntensity() const {
  std::optional<double> white;
  inThisThread([&] { white = referenceIntensity({}, {}); });
  return *white;
}

// Before anything depends on its numbers, such as the levels of subdivision.
Simulator::Simulator(Scene scene)
    : Simulator((refuseOutOfRange(scene), placedWithMotion(std::move(scene)))) {}

Simulator::Simulator(Scene scene, std::shared_ptr<const MeshMotion> motion)
    : Simulator(scene, motion, planLoop(scene, *motion)) {}

namespace {

template <typename Part, typename... Arguments>
std::unique_ptr<const Part> where(bool asked, Arguments&&... arguments) {
  return asked ? std::make_unique<const Part>(std::forward<Arguments>(arguments)...) : nullptr;
}

}  // namespace

Simulator::Simulator(Scene scene, std::shared_ptr<const MeshMotion> motion, LoopPlan plan)
    : scene_(std::move(scene)),
      motion_(std::move(motion)),
      plan_(std::move(plan)),
      cardiac_clock_(scene_),
      chain_(scene_, plan_.effects),
      rays_(scene_, plan_),
      field_(scene_, *motion_),
      trabeculae_(where<Trabeculae>(plan_.effects.trabeculae, scene_, *motion_, !plan_.slice)),
      speckle_(where<SceneSpeckle>(plan_.effects.speckle, scene_, *motion_, field_, plan_.effects,
                                   trabeculae_.get())),
      rolling_(where<RollingLines>(plan_.effects.rolling, scene_,
                                   [this](LineRange lines) {
                                     return chain_.taken(speckle_ ? speckle_->reach(lines) : lines);
                                   })),
      persistence_(where<Persistence>(plan_.effects.persistence, scene_.artefacts.persistence,
                                      cardiac_clock_, scene_.acquisition.frame_rate_hz)),
      truth_(scene_, *motion_, field_, cardiac_clock_, plan_, rolling_.get(),
             plan_.left_out.none() && !trabeculae_),
      workspaces_(scene_, *motion_, plan_) {}

}  // namespace echocine
