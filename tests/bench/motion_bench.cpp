// The look for breaks between keyframes next to making the same frames' surfaces, of the shipped
// heart on one thread: each round times one after the other, `share` is the ratio of the medians.

#include <benchmark/benchmark.h>

#include <chrono>

#include "core/parallel.h"
#include "metrics/statistics.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/surfaces/motion_warnings.h"
#include "scene/scene_reader.h"
#include "support/paths.h"

namespace echocine::bench {
namespace {

template <typename Work>
double secondsOf(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void lookForBreaks(benchmark::State& state) {
  const Scene scene =
      readScene(std::filesystem::path(support::kSourceDir) / "examples/beating_heart/scene.toml");
  const MeshMotion motion(scene);
  const CardiacClock clock(scene);
  SurfaceFrame frame;
  std::vector<double> looks, frames;
  withThreads(1, [&] {
    for (auto _ : state) {
      looks.push_back(secondsOf([&] { benchmark::DoNotOptimize(motionWarnings(scene, motion)); }));
      frames.push_back(secondsOf([&] {
        for (int i = 0; i < clock.frameCount(); ++i) motion.frameAt(clock.at(i).phase, frame);
      }));
      state.SetIterationTime(looks.back());
    }
  });
  state.counters["look_ms_per_frame"] = 1e3 * quartilesOf(looks).median / clock.frameCount();
  state.counters["motion_ms_per_frame"] = 1e3 * quartilesOf(frames).median / clock.frameCount();
  state.counters["share"] = quartilesOf(looks).median / quartilesOf(frames).median;
}

BENCHMARK(lookForBreaks)->UseManualTime()->Iterations(9)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace echocine::bench
