// Geometry and trace of one frame, 256 x 1024, one thread, meshes moving every frame: the plane
// slice, the hierarchy without and with refraction, and the bare loop that is the slice's floor.
// Compare within one run.

#include <benchmark/benchmark.h>

#include "bench/bare_slice.h"
#include "core/parallel.h"

namespace echocine::bench {
namespace {

// Runs body(frame) once per iteration on one thread; only its own time counts.
template <typename Body>
void overFrames(benchmark::State& state, const BenchScene& scene, Body&& body) {
  withThreads(1, [&] {
    std::size_t i = 0;
    for (auto _ : state) body(scene.frames[i++ % scene.frames.size()]);
  });
}

void bareSlice(benchmark::State& state) {
  const BenchScene scene(static_cast<int>(state.range(0)));
  BareSlice bare(scene);
  overFrames(state, scene,
             [&](const SurfaceFrame& frame) { benchmark::DoNotOptimize(bare.run(frame)); });
}

void planeSlice(benchmark::State& state, bool cells) {
  const BenchScene scene(static_cast<int>(state.range(0)));
  const EffectPlan plan = planEffects(scene.scene);
  const TraceSettings settings(scene.scene, plan, cells);
  const PlaneRequest request = planeRequest(scene.scene, plan);
  PlaneSlice slice(scene.topology, scene.scene.probe);
  PolarFrame polar;
  overFrames(state, scene, [&](const SurfaceFrame& frame) {
    slice.update(frame);
    traceFrame(slice, scene.scene.probe, settings, request, polar);
  });
}

void hierarchy(benchmark::State& state, bool refraction) {
  const BenchScene scene(static_cast<int>(state.range(0)));
  EffectPlan plan = planEffects(scene.scene);
  plan.refraction = refraction;
  TraceSettings settings(scene.scene, plan);
  if (refraction) settings.media[1].sound_speed_m_s = 1570;
  const PlaneRequest request = planeRequest(scene.scene, plan);
  FrameGeometry geometry(scene.topology);
  PolarFrame polar;
  overFrames(state, scene, [&](const SurfaceFrame& frame) {
    geometry.update(frame);
    traceFrame(geometry, scene.scene.probe, settings, request, polar);
  });
}

void planeSliceAlone(benchmark::State& state) {
  const BenchScene scene(static_cast<int>(state.range(0)));
  PlaneSlice slice(scene.topology, scene.scene.probe);
  overFrames(state, scene, [&](const SurfaceFrame& frame) { slice.update(frame); });
}

void triangles(benchmark::internal::Benchmark* b) {
  b->Arg(5000)->Arg(50000)->Arg(500000)->Unit(benchmark::kMillisecond);
}

BENCHMARK(bareSlice)->Apply(triangles);
BENCHMARK(planeSliceAlone)->Apply(triangles);
BENCHMARK_CAPTURE(planeSlice, centres, false)->Apply(triangles);
BENCHMARK_CAPTURE(planeSlice, cells, true)->Apply(triangles);
BENCHMARK_CAPTURE(hierarchy, straight, false)->Apply(triangles);
BENCHMARK_CAPTURE(hierarchy, refraction, true)->Apply(triangles);

}  // namespace
}  // namespace echocine::bench
