#include "loop/render_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <new>
#include <vector>

#include "core/error.h"
#include "core/out_of_memory.h"
#include "core/parallel.h"
#include "core/stage_clock.h"
#include "core/stop.h"
#include "frame/making.h"
#include "frame/workspace.h"
#include "loop/kept_frames.h"
#include "motion/cycle/cardiac_clock.h"
#include "plan/loop_plan.h"

namespace echocine {

namespace {

// One frame: from its instant, or from what was kept of its rays, into the sink.
std::shared_ptr<void> makeFrame(const Simulator& simulator, const FrameTime& time, double white,
                                KeptFrames& kept, FrameSink& sink) {
  const OutputSettings& output = simulator.scene().output;
  const std::shared_ptr<Workspace> workspace = simulator.workspace();
  MadeFrame made{time, *workspace, {}, {}};
  if (!kept.take(time.frame, workspace->polar, made.volumes_ml))
    made.volumes_ml = simulator.make(time, {.received = sink.receiver(time)}, *workspace);
  simulator.picture(white, time, *workspace, output.pictures());
  if (sink.wantsTruth() && simulator.truth() != nullptr)
    made.truth = simulator.clock().time(Stage::truth,
                                        [&] { return simulator.truthAt(time, workspace.get()); });
  // A frame that is whole goes into the sink whole.
  std::shared_ptr<void> taken;
  unstoppable([&] { taken = sink.take(made); });
  return taken;
}

// The least index of those that were given up.
class FirstLeft {
 public:
  void leave(std::size_t index) {
    std::size_t first = first_;
    while (index < first && !first_.compare_exchange_weak(first, index)) {
    }
  }
  std::size_t operator()() const { return first_; }

 private:
  std::atomic<std::size_t> first_{std::numeric_limits<std::size_t>::max()};
};

// A stop gives up the frames in the making; those before them are kept.
int renderEach(const Simulator& simulator, std::span<const FrameTime> times, double white,
               KeptFrames& kept, FrameSink& sink, const Monitor& monitor) {
  FirstLeft left;
  const auto make = [&](std::size_t i) -> std::shared_ptr<void> {
    try {
      return makeFrame(simulator, times[i], white, kept, sink);
    } catch (const Stopped&) {
      left.leave(i);
      return nullptr;
    } catch (const std::bad_alloc&) {
      throw JobError(fmt::format("frame {}: {}", times[i].frame, kOutOfMemory));
    }
  };
  const auto collect = [&](std::size_t i, const std::shared_ptr<void>& taken) {
    if (i >= left()) return;
    unstoppable([&] { sink.inOrder(taken.get()); });
    monitor.tell({Task::rendering, i + 1, times.size()});
  };
  const std::size_t made =
      parallelOrdered(0, times.size(), 2 * static_cast<std::size_t>(threadCount()),
                      monitor.keep_going, make, collect);
  return static_cast<int>(std::min(made, left()));
}

}  // namespace

int renderFrames(const Simulator& simulator, std::pair<int, int> range, FrameSink& sink,
                 const Monitor& monitor) {
  if (sink.wantsTruth())
    simulator.truth();  // rejects impossible requests before anything is traced
  KeptFrames kept(range);
  // White goes by still frames: a rolling one is traced again.
  KeepTraced keep;
  if (!simulator.plan().effects.rolling)
    keep = [&](int frame, PolarFrame&& polar, Volumes&& volumes_ml) {
      kept.keep(frame, std::move(polar), std::move(volumes_ml));
    };
  const std::optional<double> white = simulator.referenceIntensity(monitor, keep);
  if (!white) return 0;
  std::vector<FrameTime> times;
  for (int i = range.first; i < range.second; ++i) times.push_back(simulator.cardiacClock().at(i));
  sink.begin(*white);
  return renderEach(simulator, times, *white, kept, sink, monitor);
}

int renderFrames(const Simulator& simulator, std::span<const FrameTime> times, double white,
                 FrameSink& sink, const Monitor& monitor) {
  KeptFrames none({0, 0});
  return renderEach(simulator, times, white, none, sink, monitor);
}

}  // namespace echocine
