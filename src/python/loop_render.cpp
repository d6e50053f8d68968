// A loop straight into memory, without files: the stages that renderLoop() calls, but for encoding.

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "python/loop.h"
#include "render/reference_pass.h"

namespace echocine::python {

namespace {

template <typename T, typename Range>
void put(std::vector<T>& loop, std::size_t frame, const Range& plane) {
  std::copy(plane.begin(), plane.end(),
            loop.begin() + static_cast<std::ptrdiff_t>(frame * plane.size()));
}

// Memory for what the scene asks for; nothing else is made.
void reserve(const Simulator& simulator, LoopArrays& loop) {
  const OutputSettings& output = loop.scene.output;
  const auto frames = static_cast<std::size_t>(loop.frames);
  const std::size_t plane =
      static_cast<std::size_t>(loop.lines) * static_cast<std::size_t>(loop.samples);
  const std::size_t picture =
      static_cast<std::size_t>(output.width) * static_cast<std::size_t>(output.height);
  bool displacement = false, velocity = false;
  for (const Channel channel : output.channels) {
    displacement |= isMotion(channel) && channel < Channel::velocity_lateral;
    velocity |= channel >= Channel::velocity_lateral;
    if (isLabel(channel))
      loop.ids[channel].resize(frames * plane);
    else if (!isMotion(channel) && channel != Channel::display)
      loop.planes[channel].resize(frames * plane);
  }
  if (displacement) loop.displacement_mm.resize(frames * 3 * plane);
  if (velocity) loop.velocity_mm_s.resize(frames * 3 * plane);
  if (wantsPicture(loop.scene)) loop.greys.resize(frames * plane);
  if (output.cine || output.png) loop.images.resize(frames * picture);
  if (const TruthMaker* truth = simulator.truth()) {
    if (loop.scene.truth.labels) loop.labels.resize(frames * picture);
    if (loop.scene.truth.contours) loop.contours.resize(frames);
    if (loop.scene.truth.function) loop.function.resize(frames);
    if (!loop.scene.truth.tracks) return;
    loop.tracks_mm.resize(frames * truth->tracked().size() * 3);
    for (const TruthMaker::Tracked& t : truth->tracked()) {
      loop.track_layer.push_back(t.layer);
      loop.track_segment.push_back(t.segment);
    }
  }
}

void putTruth(FrameTruth truth, std::size_t frame, LoopArrays& loop) {
  if (!loop.labels.empty()) put(loop.labels, frame, truth.labels);
  if (const auto found = loop.ids.find(Channel::structure); found != loop.ids.end())
    put(found->second, frame, truth.sample_ids);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!loop.displacement_mm.empty())
      put(loop.displacement_mm, 3 * frame + i, truth.motion.displacement_mm[i]);
    if (!loop.velocity_mm_s.empty())
      put(loop.velocity_mm_s, 3 * frame + i, truth.motion.velocity_mm_s[i]);
  }
  std::size_t at = frame * truth.tracks_m.size() * 3;
  if (!loop.tracks_mm.empty())
    for (const Vec3f p : truth.tracks_m)
      for (const float metres : {p.x, p.y, p.z}) loop.tracks_mm[at++] = 1e3f * metres;
  if (!loop.function.empty() && truth.function) loop.function[frame] = *truth.function;
  if (!loop.contours.empty()) loop.contours[frame] = std::move(truth.contours);
}

// Threads write to places of their own.
class ArrayPass {
 public:
  ArrayPass(const Simulator& simulator, KeptFrames& kept, LoopArrays& loop)
      : simulator_(simulator), kept_(kept), loop_(loop), volumes_(static_cast<std::size_t>(loop.frames)) {}

  void make(std::size_t frame) {
    const FrameTime& time = loop_.times[frame];
    const std::shared_ptr<Workspace> w = simulator_.workspace();
    volumes_[frame] = traced(time, *w);
    // The greys take the intensities' memory over, so planes of channels are put first.
    for (auto& [channel, values] : loop_.planes) put(values, frame, w->polar.planes.at(channel));
    if (const auto found = loop_.ids.find(Channel::medium); found != loop_.ids.end())
      put(found->second, frame, w->polar.medium);
    const GreyImage& image =
        simulator_.picture(loop_.reference_intensity, time, *w, !loop_.images.empty());
    if (!loop_.greys.empty()) put(loop_.greys, frame, w->greys.values);
    if (!loop_.images.empty()) put(loop_.images, frame, image.pixels);
    if (simulator_.truth() != nullptr) putTruth(simulator_.truthAt(time, w.get()), frame, loop_);
  }

  void takeVolumes() {
    for (const Volumes& frame : volumes_)
      for (std::size_t s = 0; s < frame.size(); ++s) {
        if (loop_.volumes_ml.size() <= s) loop_.volumes_ml.push_back({frame[s].first, {}});
        loop_.volumes_ml[s].second.push_back(frame[s].second);
      }
  }

 private:
  Volumes traced(const FrameTime& time, Workspace& w) {
    {
      const std::lock_guard lock(mutex_);
      if (const auto found = kept_.find(time.frame); found != kept_.end()) {
        w.polar = std::move(found->second.polar);
        Volumes volumes_ml = std::move(found->second.volumes_ml);
        kept_.erase(found);
        return volumes_ml;
      }
    }
    return simulator_.trace(time, w);
  }

  const Simulator& simulator_;
  KeptFrames& kept_;
  LoopArrays& loop_;
  std::vector<Volumes> volumes_;
  std::mutex mutex_;
};

void renderInto(const Simulator& simulator, std::pair<int, int> range, const Monitor& monitor,
                LoopArrays& loop) {
  const JobError stopped("stopped before the loop was finished");
  simulator.truth();  // refuses what it cannot tell before anything is traced
  KeptFrames kept;
  const std::optional<double> reference = findReference(simulator, range, monitor, kept);
  if (!reference) throw stopped;
  loop.reference_intensity = *reference;
  reserve(simulator, loop);
  ArrayPass pass(simulator, kept, loop);
  const auto count = static_cast<std::size_t>(loop.frames);
  const std::size_t done = parallelOrdered(
      0, count, 2 * static_cast<std::size_t>(threadCount()), monitor.keep_going,
      [&](std::size_t i) -> std::shared_ptr<void> {
        pass.make(i);
        return nullptr;
      },
      [&](std::size_t i, const std::shared_ptr<void>&) {
        monitor.tell({Task::rendering, i + 1, count});
      });
  if (done < count) throw stopped;
  pass.takeVolumes();
}

}  // namespace

LoopArrays renderArrays(const Scene& scene, std::pair<int, int> range, int threads,
                        const Monitor& monitor) {
  LoopArrays loop;
  loop.scene = scene;
  loop.frames = range.second - range.first;
  loop.lines = scene.probe.lines;
  loop.samples = scene.probe.samples;
  loop.width = scene.output.width;
  loop.height = scene.output.height;
  for (const std::string& warning : scene.warnings) monitor.warn(warning);
  const CardiacClock clock(scene);
  for (int i = range.first; i < range.second; ++i) loop.times.push_back(clock.at(i));
  withThreads(threads, [&] {
    const Simulator simulator(scene);
    for (const std::string& warning : simulator.plan().warnings) monitor.warn(warning);
    renderInto(simulator, range, monitor, loop);
  });
  return loop;
}

}  // namespace echocine::python
