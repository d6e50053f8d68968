#include "frame/simulator.h"

#include <fmt/format.h>

#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "frame/frame_stages.h"
#include "frame/loop_instant.h"
#include "frame/plan_loop.h"
#include "frame/reference_frames.h"
#include "motion/surfaces/probe_placement.h"
#include "scene/scene_keys.h"

namespace echocine {

Frame Simulator::frame(double time_s) const {
  Frame made;
  frame(time_s, made);
  return made;
}

void Simulator::frame(double time_s, Frame& made) const {
  const double end_s = cardiacClock().frameCount() / scene().acquisition.frame_rate_hz;
  if (!(time_s >= 0 && time_s <= end_s))
    throw SceneError(
        fmt::format("the frame at {} s is not in the loop, accepted: 0 to {:g} s "
                    "(acquisition.beats, acquisition.frame_rate_hz)",
                    time_s, end_s));
  made.time = instantOf(cardiacClock(), scene(), time_s);
  const double white = referenceIntensity();
  const std::shared_ptr<Workspace> w = workspace();
  inThisThread([&] {
    made.volumes_ml = trace(made.time, *w);
    made.intensities.values.assign(w->polar.intensities.begin(), w->polar.intensities.end());
    picture(white, made.time, *w, wantsPicture(scene()));
    made.truth.reset();
    if (truth() != nullptr) made.truth = truthAt(made.time, w.get());
  });
  made.lines = scene().probe.lines;
  made.samples = scene().probe.samples;
  std::swap(made.greys, w->greys);
  std::swap(made.image, w->image);
  // Planes of another scene's frame stay out of this one's workspace.
  std::erase_if(made.channels,
                [&](const auto& plane) { return !w->polar.planes.contains(plane.first); });
  std::swap(made.channels, w->polar.planes);
  made.medium.clear();  // white may have had it traced
  if (wants(scene(), Channel::medium)) std::swap(made.medium, w->polar.medium);
}

std::optional<double> Simulator::referenceIntensity(const Monitor& monitor,
                                                    const KeepTraced& keep) const {
  auto& white = stages_->white;
  const std::lock_guard lock(white.mutex);
  // A thread that waits in here takes no work from outside, which might ask for white too.
  if (!white.value)
    isolated([&] {
      std::vector<FrameTime> times;
      for (const int i : referenceFrames(cardiacClock().frameCount()))
        times.push_back(cardiacClock().at(i));
      white.value = measureWhite(*this, times, monitor, keep);
    });
  return white.value;
}

double Simulator::referenceIntensity() const {
  std::optional<double> white;
  inThisThread([&] { white = referenceIntensity({}, {}); });
  return *white;
}

// Before anything depends on its numbers, such as the levels of subdivision.
Simulator::Simulator(Scene scene)
    : Simulator((refuseOutOfRange(scene), placedWithMotion(std::move(scene)))) {}

Simulator::Simulator(Scene scene, std::shared_ptr<const MeshMotion> motion,
                     std::shared_ptr<const MotionField> field)
    : Simulator(scene, motion, planLoop(scene, *motion), nullptr, std::move(field)) {}

Simulator::Simulator(Scene scene, std::shared_ptr<const MeshMotion> motion, LoopPlan plan,
                     const SceneSpeckle* source, std::shared_ptr<const MotionField> field)
    : stages_(std::make_unique<const FrameStages>(std::move(scene), std::move(motion),
                                                  std::move(plan), source, nullptr,
                                                  std::move(field))) {}

Simulator::Simulator(Scene scene, const Simulator& source)
    : Simulator(std::move(scene), source.sharedMotion(), source.plan(),
                source.sharedSpeckle().get()) {}

Simulator::~Simulator() = default;

Volumes Simulator::make(const FrameTime& time, const Making& making, Workspace& workspace) const {
  return stages_->make(time, making, workspace);
}

Volumes Simulator::trace(const FrameTime& time, Workspace& workspace) const {
  return make(time, {}, workspace);
}

GreyImage& Simulator::picture(double white, const FrameTime& time, Workspace& workspace,
                              bool wanted) const {
  make(time, {.traced = true, .picture = wanted, .white = white}, workspace);
  return workspace.image;
}

const Scene& Simulator::scene() const {
  return stages_->scene;
}

const MeshMotion& Simulator::motion() const {
  return *stages_->motion;
}

const std::shared_ptr<const MeshMotion>& Simulator::sharedMotion() const {
  return stages_->motion;
}

const std::shared_ptr<const SceneSpeckle>& Simulator::sharedSpeckle() const {
  return stages_->effects.speckle;
}

const LoopPlan& Simulator::plan() const {
  return stages_->plan;
}

const CardiacClock& Simulator::cardiacClock() const {
  return stages_->cardiac_clock;
}

const SignalChain& Simulator::chain() const {
  return stages_->chain;
}

StageClock& Simulator::clock() const {
  return stages_->clock;
}

WorkCounts Simulator::work() const {
  return stages_->tally.work();
}

int Simulator::tracedFrames() const {
  return stages_->tally.frames();
}

std::shared_ptr<Workspace> Simulator::workspace() const {
  return stages_->workspaces.borrow();
}

const TruthMaker* Simulator::truth() const {
  return stages_->truth.maker();
}

FrameTruth Simulator::truthAt(const FrameTime& time, const Workspace* traced) const {
  return stages_->truth.at(time, traced);
}

void passWarnings(const Simulator& simulator, const Monitor& monitor) {
  for (const auto& warnings : {simulator.scene().warnings, simulator.plan().warnings})
    for (const std::string& warning : warnings) monitor.warn(warning);
}

}  // namespace echocine
