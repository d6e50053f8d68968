#include "loop/loop.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/parallel.h"
#include "frame/workspace.h"
#include "loop/render_frames.h"
#include "motion/cycle/cardiac_clock.h"
#include "truth/frame_truth.h"

namespace echocine {

namespace {

template <typename T, typename Range>
void put(std::vector<T>& loop, std::size_t frame, const Range& plane) {
  std::copy(plane.begin(), plane.end(),
            loop.begin() + static_cast<std::ptrdiff_t>(frame * plane.size()));
}

// Memory for what the scene asks for; nothing else is made.
void reserve(const Simulator& simulator, Loop& loop) {
  const OutputSettings& output = loop.scene.output;
  const auto frames = static_cast<std::size_t>(loop.frames);
  const std::size_t plane =
      static_cast<std::size_t>(loop.lines) * static_cast<std::size_t>(loop.samples);
  const std::size_t picture =
      static_cast<std::size_t>(output.width) * static_cast<std::size_t>(output.height);
  bool displacement = false, velocity = false, beam = false;
  for (const Channel channel : output.channels) {
    if (!wants(loop.scene, channel)) continue;  // planes are made for the stack alone
    displacement |= isMotion(channel) && !isVelocity(channel);
    beam |= channel == Channel::velocity_beam;
    velocity |= isVelocity(channel) && channel != Channel::velocity_beam;
    if (isLabel(channel))
      loop.ids[channel].resize(frames * plane);
    else if (!isMotion(channel) && channel != Channel::display)
      loop.planes[channel].resize(frames * plane);
  }
  if (displacement) loop.displacement_mm.resize(frames * 3 * plane);
  if (velocity) loop.velocity_mm_s.resize(frames * 3 * plane);
  if (beam) loop.velocity_beam_m_s.resize(frames * plane);
  if (wantsPicture(loop.scene)) loop.greys.resize(frames * plane);
  if (output.pictures()) loop.images.resize(frames * picture);
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

void putTruth(FrameTruth truth, std::size_t frame, Loop& loop) {
  if (!loop.labels.empty()) put(loop.labels, frame, truth.labels);
  if (const auto found = loop.ids.find(Channel::structure); found != loop.ids.end())
    put(found->second, frame, truth.sample_ids);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!loop.displacement_mm.empty())
      put(loop.displacement_mm, 3 * frame + i, truth.motion.displacement_mm[i]);
    if (!loop.velocity_mm_s.empty())
      put(loop.velocity_mm_s, 3 * frame + i, truth.motion.velocity_mm_s[i]);
  }
  if (!loop.velocity_beam_m_s.empty()) put(loop.velocity_beam_m_s, frame, truth.motion.beam_m_s);
  std::size_t at = frame * truth.tracks_m.size() * 3;
  if (!loop.tracks_mm.empty())
    for (const Vec3f p : truth.tracks_m)
      for (const float metres : {p.x, p.y, p.z}) loop.tracks_mm[at++] = 1e3f * metres;
  if (!loop.function.empty() && truth.function) loop.function[frame] = *truth.function;
  if (!loop.contours.empty()) loop.contours[frame] = std::move(truth.contours);
}

// Threads write to places of their own.
class ArraySink : public FrameSink {
 public:
  ArraySink(const Simulator& simulator, int first, Loop& loop)
      : simulator_(simulator),
        first_(first),
        loop_(loop),
        volumes_(static_cast<std::size_t>(loop.frames)) {}

  void begin(double white) override {
    loop_.reference_intensity = white;
    reserve(simulator_, loop_);
  }

  std::shared_ptr<void> take(MadeFrame& made) override {
    const auto frame = static_cast<std::size_t>(made.time.frame - first_);
    const Workspace& w = made.workspace;
    volumes_[frame] = std::move(made.volumes_ml);
    for (auto& [channel, values] : loop_.planes) put(values, frame, w.polar.planes.at(channel));
    if (const auto found = loop_.ids.find(Channel::medium); found != loop_.ids.end())
      put(found->second, frame, w.polar.medium);
    if (!loop_.greys.empty()) put(loop_.greys, frame, w.greys.values);
    if (!loop_.images.empty()) put(loop_.images, frame, w.image.pixels);
    if (made.truth) putTruth(std::move(*made.truth), frame, loop_);
    return nullptr;
  }

  void finish() {
    for (const Volumes& frame : volumes_)
      for (std::size_t s = 0; s < frame.size(); ++s) {
        if (loop_.volumes_ml.size() <= s) loop_.volumes_ml.push_back({frame[s].first, {}});
        loop_.volumes_ml[s].second.push_back(frame[s].second);
      }
  }

 private:
  const Simulator& simulator_;
  const int first_;
  Loop& loop_;
  std::vector<Volumes> volumes_;
};

void checkRange(std::pair<int, int> range, int count) {
  if (range.first < 0 || range.first >= range.second || range.second > count)
    throw SceneError(
        fmt::format("frames: ({}, {}) is not in the loop, accepted: (A, B) with 0 <= A < B <= {}",
                    range.first, range.second, count));
}

}  // namespace

Loop renderInMemory(const Simulator& simulator, std::pair<int, int> range, const Monitor& monitor,
                    int threads) {
  const CardiacClock& clock = simulator.cardiacClock();
  checkRange(range, clock.frameCount());
  Loop loop;
  loop.scene = simulator.scene();
  loop.frames = range.second - range.first;
  loop.lines = loop.scene.probe.lines;
  loop.samples = loop.scene.probe.samples;
  loop.width = loop.scene.output.width;
  loop.height = loop.scene.output.height;
  for (int i = range.first; i < range.second; ++i) loop.times.push_back(clock.at(i));
  withThreads(threads, [&] {
    ArraySink sink(simulator, range.first, loop);
    if (renderFrames(simulator, range, sink, monitor) < loop.frames)
      throw JobError("stopped before the loop was finished");
    sink.finish();
  });
  return loop;
}

}  // namespace echocine
