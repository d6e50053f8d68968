#include "frame/simulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "core/usable.h"
#include "frame/plan_loop.h"
#include "frame/reference_frames.h"
#include "motion/probe_placement.h"
#include "scene/scene_keys.h"
#include "signal/reference.h"

namespace echocine {

std::vector<ChannelPlane> channelPlanes(const OutputSettings& output, const Workspace& w) {
  const PolarFrame& polar = w.polar;
  std::vector<ChannelPlane> planes;
  for (const Channel channel : output.channels) {
    if (isTruth(channel)) continue;  // of another origin
    if (channel == Channel::medium)
      planes.push_back({channel, {}, polar.medium});
    else if (channel == Channel::display)
      planes.push_back({channel, w.greys, {}});
    else
      planes.push_back({channel, polar.planes.at(channel), {}});
  }
  return planes;
}

namespace {

EchoCells echoCells(const LoopPlan& plan) {
  if (!plan.cell_echoes) return EchoCells::none;
  return plan.slice ? EchoCells::contours : EchoCells::links;
}

}  // namespace

// Before anything depends on its numbers, such as the levels of subdivision.
Simulator::Simulator(Scene scene)
    : Simulator((refuseOutOfRange(scene), placedWithMotion(std::move(scene)))) {}

Simulator::Simulator(Scene scene, std::shared_ptr<const MeshMotion> motion)
    : Simulator(scene, motion, planLoop(scene, *motion)) {}

Simulator::Simulator(Scene scene, std::shared_ptr<const MeshMotion> motion, LoopPlan plan)
    : scene_(std::move(scene)),
      motion_(std::move(motion)),
      plan_(std::move(plan)),
      cardiac_clock_(scene_),
      chain_(scene_, plan_.effects),
      settings_(scene_, plan_.effects, echoCells(plan_)),
      request_(planeRequest(scene_, plan_.effects)),
      all_lines_{0, scene_.probe.lines} {
  if (plan_.effects.rays_per_beam > 1)
    beams_.emplace(scene_.probe, beamSpread(plan_.effects, scene_.acquisition.seed));
  if (plan_.effects.trabeculae)
    trabeculae_ = std::make_unique<const Trabeculae>(scene_, *motion_, !plan_.slice);
  if (plan_.effects.speckle)
    speckle_ =
        std::make_unique<const SceneSpeckle>(scene_, *motion_, plan_.effects, trabeculae_.get());
  if (plan_.effects.rolling)
    rolling_.emplace(scene_, [this](LineRange lines) {
      return chain_.taken(speckle_ ? speckle_->reach(lines) : lines);
    });
  if (plan_.effects.persistence)
    persistence_ = std::make_unique<const Persistence>(scene_.artefacts.persistence, cardiac_clock_,
                                                       scene_.acquisition.frame_rate_hz);
}

std::shared_ptr<Workspace> Simulator::workspace() const {
  std::unique_ptr<Workspace> space;
  {
    const std::lock_guard lock(mutex_);
    if (!free_.empty()) {
      space = std::move(free_.back());
      free_.pop_back();
    }
  }
  if (!space && plan_.slice) {
    space = std::make_unique<Workspace>(
        Workspace{-1, {}, {}, PlaneSlice(motion_->surfaces(), scene_.probe, plan_.left_out), {}});
    if (plan_.effects.elevation_slices > 1)
      space->sides.emplace(motion_->surfaces(), scene_, plan_.left_out);
  }
  if (!space)
    space = std::make_unique<Workspace>(
        Workspace{-1, {}, {}, FrameGeometry(motion_->surfaces(), plan_.left_out), {}});
  return {space.release(), [this](Workspace* used) {
            const std::lock_guard lock(mutex_);
            free_.emplace_back(used);
          }};
}

Volumes Simulator::volumes(const SurfaceFrame& surfaces) const {
  Volumes volumes;
  for (const SurfaceTopology& surface : motion_->surfaces()) {
    if (surface.membrane) continue;
    volumes.emplace_back(scene_.structures[index(surface.id)].name,
                         millilitresFromCubicMetres(motion_->volumeIn(surfaces, surface)));
  }
  return volumes;
}

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

Volumes Simulator::trace(const FrameTime& time, Workspace& w) const {
  Volumes volumes_ml = traceLines(time, w);
  process(time, w);
  return volumes_ml;
}

Volumes Simulator::traceUncounted(const FrameTime& time, Workspace& w, WorkCounts& work) const {
  if (w.polar.intensities.empty()) w.polar.intensities = Intensities(w.greys.release());
  if (rolling_) work = traceRolling(time, w);
  stand(time, w);
  if (!rolling_) work = traceAt(time, nullptr, w);
  return clock_.time(Stage::motion, [&] { return volumes(w.surfaces); });
}

void Simulator::count(const WorkCounts& work) const {
  const std::lock_guard lock(mutex_);
  work_ += work;
  ++traced_frames_;
}

Volumes Simulator::traceLines(const FrameTime& time, Workspace& w) const {
  WorkCounts work;
  Volumes volumes_ml = traceUncounted(time, w, work);
  count(work);
  return volumes_ml;
}

void Simulator::processAt(const FrameTime& time, LineRange lines, Workspace& w) const {
  PolarFrame& polar = w.polar;
  const LineRange reached = speckle_ ? speckle_->reach(lines) : lines;
  clock_.time(Stage::signal, [&] {
    chain_.process(polar.intensities, reached);
    chain_.process(polar.coherent, lines);
  });
  if (speckle_)
    clock_.time(Stage::speckle, [&] {
      speckle_->apply(time, w.surfaces, polar.intensities, polar.coherent, lines);
    });
}

void Simulator::process(const FrameTime& time, Workspace& w) const {
  if (!request_.intensities) return;
  if (!rolling_) processAt(time, all_lines_, w);
  refuseUnusable(time.phase, w.polar);
}

// A frame that persists in a later one. It counts as no work of its own: how often it is made
// depends on what is still known.
Greys Simulator::greysAlone(double reference_intensity, const FrameTime& time) const {
  const std::shared_ptr<Workspace> w = workspace();
  WorkCounts uncounted;
  traceUncounted(time, *w, uncounted);
  process(time, *w);
  return chain_.compress(std::move(w->polar.intensities), reference_intensity, time.time_s);
}

GreyImage& Simulator::picture(double reference_intensity, const FrameTime& time, Workspace& w,
                              bool wanted) const {
  if (!request_.intensities) return w.image;
  clock_.time(Stage::signal, [&] {
    w.greys = chain_.compress(std::move(w.polar.intensities), reference_intensity, time.time_s);
  });
  if (persistence_)
    persistence_->apply(reference_intensity, time, w.greys, [&](const FrameTime& earlier) {
      return greysAlone(reference_intensity, earlier);
    });
  if (wanted) clock_.time(Stage::scan_conversion, [&] { chain_.picture(w.greys, w.image); });
  return w.image;
}

WorkCounts Simulator::work() const {
  const std::lock_guard lock(mutex_);
  return work_;
}

int Simulator::tracedFrames() const {
  const std::lock_guard lock(mutex_);
  return traced_frames_;
}

double Simulator::measureReference() const {
  if (scene_.signal.reference_intensity) return *scene_.signal.reference_intensity;
  if (!wantsPicture(scene_) || !plan_.effects.contrast) return 1;
  WhiteMeasure white(scene_);
  const std::shared_ptr<Workspace> w = workspace();
  for (const int i : referenceFrames(cardiac_clock_.frameCount())) {
    traceStill(cardiac_clock_.at(i), *w);
    white.add(w->polar.intensities, w->polar.medium);
  }
  // Where no frame has anything to be seen the percentile would paint an even nothing white.
  return work().crossings == 0 ? 1 : white.white();
}

double Simulator::referenceIntensity() const {
  std::call_once(reference_once_,
                 [this] { inThisThread([this] { reference_intensity_ = measureReference(); }); });
  return reference_intensity_;
}

// A frame of the loop has its very time, whatever rounding the seconds have.
FrameTime Simulator::timeOf(double time_s) const {
  const double rate_hz = scene_.acquisition.frame_rate_hz, number = std::round(time_s * rate_hz);
  if (number >= 0 && number < cardiac_clock_.frameCount() &&
      std::abs(time_s * rate_hz - number) < 1e-6)
    return cardiac_clock_.at(static_cast<int>(number));
  FrameTime time = cardiac_clock_.atTime(time_s);
  time.frame = static_cast<int>(std::floor(time_s * rate_hz));
  return time;
}

Frame Simulator::frame(double time_s) const {
  Frame made;
  frame(time_s, made);
  return made;
}

void Simulator::frame(double time_s, Frame& made) const {
  const double rate_hz = scene_.acquisition.frame_rate_hz;
  const double end_s = cardiac_clock_.frameCount() / rate_hz;
  if (!(time_s >= 0 && time_s <= end_s))
    throw SceneError(
        fmt::format("the frame at {} s is not in the loop, accepted: 0 to {:g} s "
                    "(acquisition.beats, acquisition.frame_rate_hz)",
                    time_s, end_s));
  made.time = timeOf(time_s);
  const double reference = referenceIntensity();
  const std::shared_ptr<Workspace> w = workspace();
  inThisThread([&] {
    made.volumes_ml = trace(made.time, *w);
    made.intensities.values.assign(w->polar.intensities.begin(), w->polar.intensities.end());
    picture(reference, made.time, *w, wantsPicture(scene_));
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

}  // namespace echocine
