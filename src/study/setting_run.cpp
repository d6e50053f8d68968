#include "study/setting_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <nlohmann/json.hpp>

#include "core/hash.h"
#include "core/stage_clock.h"
#include "core/stop.h"
#include "frame/plan_loop.h"
#include "loop/render_frames.h"
#include "motion/surfaces/mesh_motion.h"
#include "output/exr_plane.h"
#include "scene/elevation_slices.h"
#include "scene/scene_json.h"
#include "signal/signal_chain.h"
#include "trace/trace_frame.h"

namespace echocine {

namespace {

// Our choice: a gigabyte or so of refined meshes stays in memory for settings to come.
constexpr std::size_t kShelvedTriangles = 6'000'000;

// All that a motion depends on; what it does not depend on would only make the shelf miss.
nlohmann::ordered_json motionJson(const Scene& scene) {
  const nlohmann::ordered_json all = sceneJson(scene);
  return {all.at("motion"), all.at("structures"), all.at("accuracy").at("normals")};
}

// Nothing is written: its files need no folder, and are of no scene that could be resumed.
ExrStack exrStack(const Scene& scene, double reference_intensity) {
  return {{}, scene, std::string(64, '0'), reference_intensity};
}

// Memory goes with triangles: positions, normals and topology of each.
std::size_t trianglesOf(const MeshMotion& motion) {
  std::size_t count = 0;
  for (const SurfaceTopology& surface : motion.surfaces()) count += surface.triangles.size();
  return count;
}

}  // namespace

MotionShelf::Entry& MotionShelf::entryOf(const Scene& scene) {
  // Motions know the triangles that any slice can reach.
  const std::string key = motionJson(scene).dump() + fmt::format("{}", elevationReach(scene));
  Entry& entry = shelf_[key];
  entry.last_used = ++uses_;
  if (entry.motion) return entry;
  try {
    entry.motion = std::make_shared<const MeshMotion>(scene);
  } catch (...) {
    shelf_.erase(key);
    throw;
  }
  entry.triangles = trianglesOf(*entry.motion);
  const auto total = [this] {
    std::size_t sum = 0;
    for (const auto& [name, e] : shelf_) sum += e.triangles;
    return sum;
  };
  // The least recently used goes first, never this one. Who still uses it holds its own pointer.
  while (shelf_.size() > 1 && total() > kShelvedTriangles)
    shelf_.erase(std::min_element(shelf_.begin(), shelf_.end(), [](const auto& a, const auto& b) {
      return a.second.last_used < b.second.last_used;
    }));
  return entry;
}

std::shared_ptr<const MeshMotion> MotionShelf::motionOf(const Scene& scene) {
  return entryOf(scene).motion;
}

std::unique_ptr<const Simulator> MotionShelf::simulatorOf(const Scene& scene,
                                                          const LoopPlan& plan) {
  Entry& entry = entryOf(scene);
  auto made = std::make_unique<const Simulator>(scene, entry.motion, plan, entry.speckle.get());
  if (!entry.speckle) entry.speckle = made->sharedSpeckle();
  return made;
}

Scene showing(Scene scene) {
  if (!wantsPicture(scene)) scene.output.cine = true;
  return scene;
}

// All other decisions are those of the plan: none is taken twice.
LoopPlan meanOverSeeds(LoopPlan plan) {
  EffectPlan& effects = plan.effects;
  effects.speckle = effects.heterogeneity = effects.anisotropy = effects.coherent_echoes = false;
  effects.averaged = true;
  return plan;
}

// The motion is let go again: hundreds of settings wait, and one is at work at a time.
SettingRun::SettingRun(Scene scene, MotionShelf& shelf) : scene_(std::move(scene)), shelf_(&shelf) {
  const std::shared_ptr<const MeshMotion> motion = shelf_->motionOf(scene_);
  plan_ = planLoop(scene_, *motion);
  for (const SurfaceTopology& surface : motion->surfaces())
    if (!plan_.left_out[index(surface.id)]) vertices_ += surface.vertex_count;
}

std::string SettingRun::signature() const {
  // Where "auto" came to the same as a stated value, two scenes are one setting.
  nlohmann::ordered_json json = sceneJson(scene_);
  json["accuracy"]["interface_echo"] = plan_.cell_echoes;
  json["effects"]["refraction"] = plan_.effects.refraction;
  return json.dump();
}

const Simulator& SettingRun::simulator() {
  if (!simulator_) simulator_ = shelf_->simulatorOf(scene_, plan_);
  return *simulator_;
}

const Simulator& SettingRun::averaged() {
  const EffectPlan& effects = plan_.effects;
  if (!effects.speckle && !effects.noise && !effects.clutter) return simulator();
  if (!averaged_) averaged_ = shelf_->simulatorOf(scene_, meanOverSeeds(plan_));
  return *averaged_;
}

void SettingRun::rest() {
  simulator_.reset();
  averaged_.reset();
}

WorkCounts SettingRun::workPerFrame() {
  WorkCounts mean = averaged().work();
  const auto frames = static_cast<std::uint64_t>(std::max(averaged().tracedFrames(), 1));
  for (std::uint64_t* count : {&mean.bvh_updates, &mean.facets_sliced, &mean.rays, &mean.crossings,
                               &mean.samples_backscatter, &mean.samples_attenuated})
    // To the nearest whole; counts are of whole things.
    *count = (*count + frames / 2) / frames;
  return mean;
}

namespace {

// A second walk that keeps what it judged of each crossing, and samples nothing.
InterfaceMap interfacesOf(const Scene& scene, const EffectPlan& effects, Workspace& workspace) {
  const Probe& probe = scene.probe;
  TraceSettings settings(scene, effects);
  settings.note_hits = true;
  PlaneRequest nothing;
  nothing.intensities = false;
  PolarFrame walked;
  std::visit([&](const auto& geometry) { traceFrame(geometry, probe, settings, nothing, walked); },
             workspace.geometry);
  return interfaceMap(probe, walked.traces);
}

// Pictures in memory, of intensities as a file would keep them if `stored`.
class PictureSink : public FrameSink {
 public:
  PictureSink(const Simulator& simulator, double reference_intensity, bool with_interfaces,
              bool stored)
      : simulator_(simulator),
        stack_(exrStack(simulator.scene(), reference_intensity)),
        with_interfaces_(with_interfaces),
        stored_(stored) {}

  bool wantsTruth() const override { return false; }

  std::function<void(Intensities&)> receiver(const FrameTime& time) override {
    if (!stored_) return {};
    return [this, phase = time.phase](Intensities& received) {
      const FrameRecord record{0, 0, phase, 0};
      received.values = readBack(stack_.encode(record, {{Channel::y, received, {}}}), Channel::y);
    };
  }

  std::shared_ptr<void> take(MadeFrame& made) override {
    auto picture = std::make_shared<FramePicture>();
    picture->image = made.workspace.image;
    simulator_.chain().picture(made.workspace.greys, picture->grey);
    if (with_interfaces_)
      picture->interfaces =
          interfacesOf(simulator_.scene(), simulator_.plan().effects, made.workspace);
    return picture;
  }

  void inOrder(void* taken) override {
    pictures.push_back(std::move(*static_cast<FramePicture*>(taken)));
  }

  std::vector<FramePicture> pictures;

 private:
  const Simulator& simulator_;
  const ExrStack stack_;
  const bool with_interfaces_, stored_;
};

}  // namespace

std::vector<FramePicture> SettingRun::pictures(std::span<const FrameTime> times,
                                               double reference_intensity, bool with_interfaces,
                                               MadeOf made_of) {
  const bool stored = made_of == MadeOf::stored && scene_.output.exr;
  PictureSink sink(averaged(), reference_intensity, with_interfaces, stored);
  renderFrames(averaged(), times, reference_intensity, sink, {});
  if (sink.pictures.size() < times.size()) throw Stopped();
  return std::move(sink.pictures);
}

double SettingRun::referenceIntensity(const std::vector<FrameTime>& times) {
  return *measureWhite(averaged(), times, {}, {});
}

namespace {

// A render's files, made in memory: a study times the program, not the drive.
class EncodingSink : public FrameSink {
 public:
  EncodingSink(const Simulator& simulator, double reference_intensity)
      : clock_(simulator.clock()),
        output_(simulator.scene().output),
        stack_(exrStack(simulator.scene(), reference_intensity)),
        overlay_(simulator.scene(), simulator.chain().geometry(), {}) {}

  bool wantsTruth() const override { return false; }

  std::shared_ptr<void> take(MadeFrame& made) override {
    Workspace& w = made.workspace;
    if (output_.exr)
      clock_.time(Stage::exr, [&] {
        const auto file =
            stack_.encode({made.time.frame, 0, made.time.phase, 0}, channelPlanes(output_, w));
        sha256Hex(file);
        const std::lock_guard lock(mutex_);
        exr_bytes_[made.time.frame] = file.size();
      });
    if (output_.cine)
      clock_.time(Stage::avi, [&] {
        overlay_.draw(w.image, 0);
        encodeCineFrame(w.image, output_.codec, output_.jpeg_quality);
      });
    return nullptr;
  }

  // Mean over the different frames.
  double exrBytes() const {
    double sum = 0;
    for (const auto& [frame, bytes] : exr_bytes_) sum += static_cast<double>(bytes);
    return exr_bytes_.empty() ? 0 : sum / static_cast<double>(exr_bytes_.size());
  }

 private:
  std::mutex mutex_;
  std::map<int, std::size_t> exr_bytes_;
  StageClock& clock_;
  const OutputSettings& output_;
  const ExrStack stack_;
  const Overlay overlay_;
};

}  // namespace

StageTimes SettingRun::timeBatch(std::span<const FrameTime> times, std::size_t frames,
                                 double reference_intensity) {
  const Simulator& making = simulator();
  std::vector<FrameTime> batch;
  for (std::size_t i = 0; i < frames; ++i) batch.push_back(times[i % times.size()]);
  EncodingSink sink(making, reference_intensity);
  const std::array<double, kStages> before = making.clock().milliseconds();
  const auto start = std::chrono::steady_clock::now();
  renderFrames(making, batch, reference_intensity, sink, {});
  const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
  StageTimes taken{making.clock().milliseconds(), wall.count() / static_cast<double>(frames),
                   sink.exrBytes()};
  for (std::size_t s = 0; s < kStages; ++s)
    taken.stage_ms[s] = (taken.stage_ms[s] - before[s]) / static_cast<double>(frames);
  return taken;
}

}  // namespace echocine
