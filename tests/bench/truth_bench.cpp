// What each kind of truth adds to the whole frame without files, of the shipped heart at 256 x 1024
// and 800 x 600: `over_floor` less 1 is its time over the frame's.

#include "bench/rounds.h"
#include "frame/simulator.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/surfaces/interior_motion.h"
#include "scene/scene_reader.h"
#include "support/paths.h"
#include "support/shipped_heart.h"

namespace echocine::bench {
namespace {

constexpr int kTruthRounds = 15;

void truthOf(benchmark::State& state, void (*ask)(Scene&)) {
  Scene scene = support::shippedPaperHeart();
  scene.output.channels = {Channel::y};
  const Simulator plain(scene);
  ask(scene);
  const Simulator asked(scene, plain.sharedMotion());
  withThreads(1, [&] { asked.truth(); });
  const std::shared_ptr<Workspace> workspace = plain.workspace(), traced = asked.workspace();
  const auto time = [&](std::size_t i) {
    const CardiacClock& clock = plain.cardiacClock();
    return clock.at(static_cast<int>(i) % clock.frameCount());
  };
  overFloor(
      state,
      [&](std::size_t i) {
        benchmark::DoNotOptimize(asked.trace(time(i), *traced));
        benchmark::DoNotOptimize(asked.picture(1e-6f, time(i), *traced, true).pixels.data());
        benchmark::DoNotOptimize(asked.truthAt(time(i), traced.get()));
      },
      [&](std::size_t i) {
        benchmark::DoNotOptimize(plain.trace(time(i), *workspace));
        benchmark::DoNotOptimize(plain.picture(1e-6f, time(i), *workspace, true).pixels.data());
      });
}

void truthLabels(benchmark::State& state) {
  truthOf(state, [](Scene& scene) { scene.truth.labels = true; });
}
void truthContours(benchmark::State& state) {
  truthOf(state, [](Scene& scene) { scene.truth.contours = true; });
}
void truthTracks(benchmark::State& state) {
  truthOf(state, [](Scene& scene) { scene.truth.tracks = true; });
}
void truthFunction(benchmark::State& state) {
  truthOf(state, [](Scene& scene) { scene.truth.function = true; });
}
void truthDisplacement(benchmark::State& state) {
  truthOf(state, [](Scene& scene) {
    scene.output.channels = {Channel::y, Channel::displacement_lateral, Channel::displacement_axial,
                             Channel::displacement_elevation};
  });
}

// The field of material points itself: ours_ms is its set-up on one core.
void truthField(benchmark::State& state) {
  const Scene scene =
      readScene(std::filesystem::path(support::kSourceDir) / "examples/beating_heart/scene.toml");
  const MeshMotion motion(scene);
  withThreads(1, [&] {
    for (auto _ : state) benchmark::DoNotOptimize(interiorMotion(scene, motion));
  });
}

BENCHMARK(truthLabels)->UseManualTime()->Iterations(kTruthRounds)->Unit(benchmark::kMillisecond);
BENCHMARK(truthContours)->UseManualTime()->Iterations(kTruthRounds)->Unit(benchmark::kMillisecond);
BENCHMARK(truthDisplacement)
    ->UseManualTime()
    ->Iterations(kTruthRounds)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(truthTracks)->UseManualTime()->Iterations(kTruthRounds)->Unit(benchmark::kMillisecond);
BENCHMARK(truthFunction)->UseManualTime()->Iterations(kTruthRounds)->Unit(benchmark::kMillisecond);
BENCHMARK(truthField)->Iterations(3)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

}  // namespace
}  // namespace echocine::bench
