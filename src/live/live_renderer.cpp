#include "live/live_renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "frame/frame_stages.h"
#include "frame/making.h"
#include "frame/plan_loop.h"
#include "frame/workspace.h"
#include "motion/cycle/loop_ecg.h"
#include "motion/mesh/world_place.h"
#include "motion/surfaces/mesh_motion.h"
#include "signal/signal_chain.h"

namespace echocine::live {

namespace {

// Our choice: 128 lines follow a hand with half the time of 256, and their gaps stay invisible
// below the beam's width.
constexpr int kMovingLines = 128;
// Still pictures that are kept: two beats at 50 frames per second.
constexpr std::size_t kKeptPictures = 120;

class Watch {
 public:
  double ms() const {
    const std::chrono::duration<double, std::milli> passed =
        std::chrono::steady_clock::now() - start_;
    return passed.count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// CPU time of the program, also of a library's own threads: other programs do not add to it.
double processorTime_ms() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

FrameTime instant(const CardiacClock& clock, int frame) {
  if (frame < 0 || frame >= clock.frameCount())
    throw SceneError(fmt::format("frame: is {}, accepted: 0 to {}", frame, clock.frameCount() - 1));
  return clock.at(frame);
}

Overlay overlayOf(const Scene& scene, const SignalChain& chain, const CardiacClock& clock) {
  return {
      scene, chain.geometry(),
      scene.output.ecg ? loopEcg(clock, scene.acquisition.frame_rate_hz) : std::vector<double>{}};
}

void drawOverlay(const Overlay& overlay, LivePicture& picture) {
  overlay.draw(picture.image, static_cast<double>(picture.time.frame) / picture.frames);
}

Scene withLessEffort(const Scene& scene) {
  Scene less = pictureOnly(scene);
  less.probe.lines = std::min(less.probe.lines, kMovingLines);
  less.effects.refraction = Switch::off;
  less.accuracy.rays_per_beam = less.accuracy.elevation_slices = 1;
  less.accuracy.tracer = TracerChoice::slice;
  less.accuracy.normals = Normals::facet;
  less.acquisition.rolling = false;
  less.speckle.on = false;
  less.artefacts.persistence = 0;
  less.trabeculae.deviation_m = 0;
  less.leaflets = {};
  less.motion.subdivision = 0;  // the meshes of the instant are refined already
  // One keyframe for each structure: the meshes of the instant.
  for (Structure& structure : less.structures) structure.keyframes.resize(1);
  return less;
}

// The decisions of planLoop() that do not look at meshes. Structures out of the sector are not left
// out: finding them takes longer than tracing them once.
LoopPlan planWithoutMeshes(const Scene& scene, const LoopPlan& still) {
  LoopPlan plan;
  plan.effects = planEffects(scene);
  plan.slice = true;
  plan.cell_echoes = plan.effects.reflection && scene.probe.lines > 1 &&
                     scene.accuracy.interface_echo != InterfaceEcho::centre;
  const std::vector<double>& loss = still.effects.mean_loss;
  if (loss.size() == static_cast<std::size_t>(scene.probe.samples)) plan.effects.mean_loss = loss;
  plan.effects.clutter_window_db = still.effects.clutter_window_db;
  return plan;
}

}  // namespace

Scene pictureOnly(Scene scene) {
  scene.output.cine = true;
  scene.output.channels = {Channel::y};
  scene.truth = {};
  return scene;
}

std::string qualityWords(const Scene& scene, Effort effort) {
  if (effort == Effort::still) return fmt::format("still: {} lines, complete", scene.probe.lines);
  std::string words = fmt::format("moving: {} of {} lines",
                                  std::min(scene.probe.lines, kMovingLines), scene.probe.lines);
  if (scene.speckle.on) words += ", no speckle";
  if (scene.accuracy.elevation_slices > 1 || scene.accuracy.rays_per_beam > 1)
    words += ", imaging plane only";
  if (scene.effects.refraction != Switch::off) words += ", straight rays";
  return words;
}

struct LiveRenderer::Still {
  Still(std::string given_name, const Scene& scene, const KeyframeSet& keyframes)
      : name(std::move(given_name)),
        simulator(pictureOnly(scene), std::make_shared<const MeshMotion>(keyframes, scene)),
        overlay(overlayOf(simulator.scene(), simulator.chain(), simulator.cardiacClock())) {}

  std::string name;
  Simulator simulator;
  Overlay overlay;
  std::map<int, LivePicture> kept;
};

LiveRenderer::LiveRenderer(const Scene& scene)
    : keyframes_(readKeyframes(scene)),
      motion_(std::make_shared<const MeshMotion>(keyframes_, scene)),
      motion_pose_(scene.probe.pose),
      motion_settings_(scene.motion) {}

LiveRenderer::~LiveRenderer() = default;

LiveRenderer::Still& LiveRenderer::stillOf(const Scene& scene, const std::string& name) {
  if (!still_ || still_->name != name) still_ = std::make_unique<Still>(name, scene, keyframes_);
  return *still_;
}

const Simulator& LiveRenderer::prepared(const Scene& scene, const std::string& name) {
  return stillOf(scene, name).simulator;
}

LivePicture LiveRenderer::still(const Scene& scene, const std::string& name, int frame) {
  const Watch watch;
  Still& still = stillOf(scene, name);
  const Simulator& simulator = still.simulator;
  LivePicture picture;
  picture.time = instant(simulator.cardiacClock(), frame);
  if (const auto kept = still.kept.find(frame); kept != still.kept.end()) return kept->second;
  picture.frames = simulator.cardiacClock().frameCount();
  white_ = simulator.referenceIntensity({}, {});
  picture.prepared_ms = watch.ms();
  const std::shared_ptr<Workspace> workspace = simulator.workspace();
  picture.warnings = simulator.plan().warnings;
  picture.volumes_ml = simulator.trace(picture.time, *workspace);
  picture.image = simulator.picture(*white_, picture.time, *workspace, true);
  drawOverlay(still.overlay, picture);
  picture.milliseconds = watch.ms();
  if (still.kept.size() < kKeptPictures) still.kept.emplace(frame, picture);
  return picture;
}

// The refined meshes at a phase, in mesh units: one keyframe for each structure.
KeyframeSet LiveRenderer::meshesAt(double phase) {
  KeyframeSet set;
  motion_->frameAt(phase, surfaces_, false);
  const double per_metre = 1 / metresPerMeshUnit(motion_settings_);
  for (std::size_t s = 0; s < keyframes_.structures.size(); ++s) {
    const std::vector<MeshPart>& parts = keyframes_.structures[s].front().parts;
    KeyframeMesh mesh{{{}, motion_->surfaces()[s].triangles, {}, {}}, {parts.front()}};
    mesh.mesh.positions.reserve(surfaces_.positions_m[s].size());
    for (const Vec3f p : surfaces_.positions_m[s])
      mesh.mesh.positions.push_back(
          per_metre * (motion_pose_.toWorld(toDouble(p)) - motion_settings_.mesh_offset_m));
    set.structures.push_back({std::move(mesh)});
  }
  return set;
}

LivePicture LiveRenderer::moving(const Scene& scene, const std::string& settings, int frame) {
  const Watch watch;
  const Scene less = withLessEffort(scene);
  LivePicture picture;
  const CardiacClock clock(scene);
  picture.time = instant(clock, frame);
  picture.frames = clock.frameCount();
  if (!white_ && !scene.signal.reference_intensity)
    white_ = stillOf(scene, settings).simulator.referenceIntensity({}, {});
  auto motion = std::make_shared<const MeshMotion>(meshesAt(picture.time.phase), less);
  const LoopPlan plan = planWithoutMeshes(less, still_ ? still_->simulator.plan() : LoopPlan{});
  const std::string chain_name = settings + (still_ ? still_->name : "");
  const bool known = chain_ && settings_ == chain_name;
  const FrameStages stages(less, std::move(motion), plan, nullptr, known ? chain_ : nullptr);
  if (!known) {
    settings_ = chain_name;
    chain_ = stages.shared_chain;
    overlay_.emplace(overlayOf(less, *chain_, clock));
  }
  picture.prepared_ms = watch.ms();
  const double white = scene.signal.reference_intensity.value_or(white_.value_or(0));
  {
    const std::shared_ptr<Workspace> workspace = stages.workspaces.borrow();
    stages.make(picture.time, {.still = true, .persists = false, .picture = true, .white = white},
                *workspace);
    picture.image = std::move(workspace->image);
  }
  drawOverlay(*overlay_, picture);
  picture.milliseconds = watch.ms();
  return picture;
}

double LiveRenderer::cost_ms(const Scene& scene, int frame) const {
  const Simulator simulator(pictureOnly(scene),
                            std::make_shared<const MeshMotion>(keyframes_, scene));
  const int frames = simulator.cardiacClock().frameCount();
  instant(simulator.cardiacClock(), frame);  // is it in the loop?
  const double white = scene.signal.reference_intensity.value_or(white_.value_or(1));
  const std::shared_ptr<Workspace> workspace = simulator.workspace();
  double least_ms = INFINITY;
  inThisThread([&] {
    // The first one fills caches. A frame that a workspace holds already is not traced again, so
    // the next ones follow.
    for (int i = 0; i < 4; ++i) {
      const FrameTime time = instant(simulator.cardiacClock(), (frame + i) % frames);
      const double before_ms = processorTime_ms();
      simulator.trace(time, *workspace);
      simulator.picture(white, time, *workspace, true);
      if (i > 0 || frames == 1) least_ms = std::min(least_ms, processorTime_ms() - before_ms);
      if (frames == 1) break;
    }
  });
  return least_ms;
}

}  // namespace echocine::live
