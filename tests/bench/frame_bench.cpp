// The whole frame, meshes moving, next to the sum of its stages' floors; then with its files, on
// one core and on two. Sizes: triangles / lines / samples -> 800 x 600.

#include <chrono>
#include <memory>
#include <optional>

#include "bench/bench_loop.h"
#include "bench/floor/bare_files.h"
#include "bench/floor/bare_hierarchy.h"
#include "bench/floor/bare_motion.h"
#include "bench/floor/bare_signal.h"
#include "bench/floor/bare_slice.h"
#include "bench/rounds.h"
#include "frame/simulator.h"
#include "motion/cycle/cardiac_clock.h"
#include "render/render.h"
#include "scene/scene_reader.h"

namespace echocine::bench {
namespace {

constexpr float kReference = 1e-6f, kRange_db = 60;
constexpr int kRounds = 20;

// The floors of all stages one after the other.
class BareFrame {
 public:
  explicit BareFrame(const BenchScene& scene)
      : scene_(scene),
        motion_(scene),
        slice_(scene),
        average_(scene.scene),
        converter_(scene.scene, pictureGeometry(scene.scene)),
        files_(scene.scene) {}

  void clearFiles() { files_.clear(); }

  void run(std::size_t i, bool with_files) {
    motion_.blend(i);
    benchmark::DoNotOptimize(motion_.volumes());
    slice_.slice(scene_.frame(i));
    std::vector<float>& plane = slice_.fill();
    if (with_files) {  // the stack's intensities are not the picture's
      files_.exr(plane, i);
      slice_.fill();
    }
    average_.run(plane);
    log_.run(plane, kReference, kRange_db, grey_);
    const std::vector<std::uint8_t>& picture = converter_.run(grey_.data);
    benchmark::DoNotOptimize(picture.data());
    if (with_files) files_.jpeg(picture, scene_.scene.output.jpeg_quality);
  }

 private:
  const BenchScene& scene_;
  BareMotion motion_;
  BareSlice slice_;
  BareAverage average_;
  BareLog log_;
  cv::Mat grey_;
  BareScanConversion converter_;
  BareFiles files_;
};

FrameTime frameTime(std::size_t i) {
  return {.phase = BenchScene::phase(i), .frame = static_cast<int>(i)};
}

// over_single_rays: the same over one bare pass of single rays through Embree, already refitted.
void wholeFrame(benchmark::State& state) {
  const BenchScene bare_scene{Size(state)};
  const LoopOnDisk loop(bare_scene, false);
  const Scene scene = readScene(loop.sceneFile());
  const Simulator simulator(scene);
  BareFrame bare(bare_scene);
  BareHierarchy rays(bare_scene);
  const std::shared_ptr<Workspace> workspace = simulator.workspace();
  std::vector<double> over_rays;
  const auto ours = [&](std::size_t i) {
    benchmark::DoNotOptimize(simulator.trace(frameTime(i), *workspace));
    benchmark::DoNotOptimize(
        simulator.picture(kReference, frameTime(i), *workspace, true).pixels.data());
  };
  overFloor(state, ours, [&](std::size_t i) { bare.run(i, false); });
  withThreads(1, [&] {
    for (std::size_t round = 0; round < kRounds; ++round) {
      double rays_ms = 0;
      for (std::size_t i = 0; i < kTogether; ++i) {
        rays.refit(bare_scene.frame(i));
        rays_ms += millisecondsOf([&] { benchmark::DoNotOptimize(rays.singleRays()); });
      }
      over_rays.push_back(millisecondsOfEach(round, ours) * kTogether / rays_ms);
    }
  });
  state.counters["over_single_rays"] = quartilesOf(over_rays).median;
}

// The whole frame with speckle next to the same frame without it.
void speckleFrame(benchmark::State& state) {
  const BenchScene bare_scene{Size(state)};
  const LoopOnDisk loop(bare_scene, false);
  Scene scene = readScene(loop.sceneFile());
  const Simulator without(scene);
  scene.speckle.on = true;
  std::optional<Simulator> with;
  withThreads(1, [&] { with.emplace(scene, without.sharedMotion()); });
  const auto made = [](const Simulator& simulator) {
    return [&simulator, w = simulator.workspace()](std::size_t i) {
      benchmark::DoNotOptimize(simulator.trace(frameTime(i), *w));
      benchmark::DoNotOptimize(simulator.picture(kReference, frameTime(i), *w, true).pixels.data());
    };
  };
  overFloor(state, made(*with), made(without));
}

// Whole frames at the loop's own instants.
auto wholeFrames(const Simulator& simulator) {
  return [&simulator, w = simulator.workspace()](std::size_t i) {
    const CardiacClock& clock = simulator.cardiacClock();
    const FrameTime time = clock.at(static_cast<int>(i) % clock.frameCount());
    benchmark::DoNotOptimize(simulator.trace(time, *w));
    benchmark::DoNotOptimize(simulator.picture(kReference, time, *w, true).pixels.data());
  };
}

// A scene's frames with a change next to those without, at the loop's own instants.
template <typename Change>
void changedFrame(benchmark::State& state, const Scene& scene, const Change& change) {
  const Simulator without(scene);
  Scene changed = scene;
  change(changed);
  std::optional<Simulator> with;
  withThreads(1, [&] { with.emplace(changed, without.sharedMotion()); });
  overFloor(state, wholeFrames(*with), wholeFrames(without));
}

// The whole frame with all artefacts, but for persistence, next to the same frame without them.
void artefactFrame(benchmark::State& state) {
  const BenchScene bare_scene{Size(state)};
  const LoopOnDisk loop(bare_scene, false);
  Scene scene = readScene(loop.sceneFile());
  scene.speckle.on = state.range(3) != 0;
  changedFrame(state, scene, [](Scene& s) {
    s.artefacts.dropout = s.artefacts.acoustic_window = s.artefacts.haze = true;
    s.artefacts.reverberation = s.artefacts.clutter = s.artefacts.noise = true;
  });
}

// Frames of a beam that is thick across the plane, by slices, next to those of the plane alone.
void elevationFrame(benchmark::State& state) {
  const BenchScene bare_scene{Size(state)};
  const LoopOnDisk loop(bare_scene, false);
  Scene scene = readScene(loop.sceneFile());
  scene.accuracy.elevation_slices = static_cast<int>(state.range(3));
  scene.speckle.on = state.range(4) != 0;
  const Simulator thick(scene);
  scene.accuracy.elevation_slices = 1;
  const Simulator thin(scene, thick.sharedMotion());
  overFloor(state, wholeFrames(thick), wholeFrames(thin));
}

// Frames whose lines roll, by lines to a group, next to still ones.
void rollingFrame(benchmark::State& state) {
  const BenchScene bare_scene{Size(state)};
  const LoopOnDisk loop(bare_scene, false);
  Scene scene = readScene(loop.sceneFile());
  scene.speckle.on = state.range(4) != 0;
  changedFrame(state, scene, [&](Scene& s) {
    s.acquisition.rolling = true;
    s.accuracy.rolling_lines = static_cast<int>(state.range(3));
  });
}

struct LoopTime {
  double cpu_ms = 0, wall_ms = 0;  // per frame, the first ones left out
};

LoopTime renderedLoop(const Scene& scene, const std::filesystem::path& folder, int threads) {
  constexpr int kFirst = 8;
  using Clock = std::chrono::steady_clock;
  double cpu = 0;
  Clock::time_point wall;
  LoopTime time;
  Monitor monitor;
  monitor.tell = [&](const Progress& progress) {
    if (progress.done == std::size_t{kFirst}) {
      cpu = cpuMilliseconds();
      wall = Clock::now();
    }
    if (progress.done != progress.total) return;
    time.cpu_ms = (cpuMilliseconds() - cpu) / static_cast<double>(progress.total - kFirst);
    time.wall_ms = std::chrono::duration<double, std::milli>(Clock::now() - wall).count() /
                   static_cast<double>(progress.total - kFirst);
  };
  RenderOptions options;
  options.folder = folder;
  options.threads = threads;
  renderLoop(scene, options, monitor);
  return time;
}

// two_cores: frames per second of wall time on two cores over those on one.
void withFiles(benchmark::State& state) {
  const BenchScene bare_scene{Size(state)};
  const LoopOnDisk loop(bare_scene, true);
  const Scene scene = readScene(loop.sceneFile());
  BareFrame bare(bare_scene);
  std::vector<double> over_floor, ours, floors, gains;
  for (auto _ : state) {
    const LoopTime one = renderedLoop(scene, loop.folder() / "out", 1);
    const LoopTime two = renderedLoop(scene, loop.folder() / "out", 2);
    double floor_ms = 0;
    bare.clearFiles();
    withThreads(1, [&] {
      floor_ms = millisecondsOf([&] {
                   for (std::size_t i = 0; i < LoopOnDisk::kFrames; ++i) bare.run(i, true);
                 }) /
                 LoopOnDisk::kFrames;
    });
    ours.push_back(one.cpu_ms);
    floors.push_back(floor_ms);
    over_floor.push_back(one.cpu_ms / floor_ms);
    gains.push_back(one.wall_ms / two.wall_ms);
    state.SetIterationTime(1e-3 * one.wall_ms);
  }
  state.counters["ours_ms"] = quartilesOf(ours).median;
  state.counters["floor_ms"] = quartilesOf(floors).median;
  state.counters["over_floor"] = quartilesOf(over_floor).median;
  state.counters["two_cores"] = quartilesOf(gains).median;
}

BENCHMARK(wholeFrame)
    ->Args({5000, 256, 1024})
    ->Args({50000, 256, 1024})
    ->Args({500000, 256, 1024})
    ->Args({50000, 128, 1024})
    ->Args({50000, 512, 1024})
    ->Args({50000, 256, 512})
    ->Args({50000, 256, 2048})
    ->Args({50000, 512, 2048})
    ->UseManualTime()
    ->Iterations(kRounds)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(speckleFrame)
    ->Args({50000, 256, 1024})
    ->Args({50000, 128, 1024})
    ->UseManualTime()
    ->Iterations(kRounds)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(artefactFrame)
    ->ArgsProduct({{50000}, {256}, {1024}, {0, 1}})
    ->UseManualTime()
    ->Iterations(kRounds)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(elevationFrame)
    ->ArgsProduct({{50000}, {256}, {1024}, {3, 5}, {0, 1}})
    ->UseManualTime()
    ->Iterations(kRounds)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(rollingFrame)
    ->ArgsProduct({{50000}, {256}, {1024}, {8, 16, 32, 64, 128}, {0, 1}})
    ->UseManualTime()
    ->Iterations(kRounds)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(withFiles)
    ->Args({50000, 256, 1024})
    ->UseManualTime()
    ->Iterations(7)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace echocine::bench
