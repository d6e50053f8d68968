// Rays through Embree's hierarchy next to their floor: straight, bent, and several to a beam.

#include "bench/floor/bare_hierarchy.h"
#include "bench/rounds.h"
#include "bench/sizes.h"
#include "scene/scan_geometry.h"
#include "trace/trace_beams.h"

namespace echocine::bench {
namespace {

// The rays of a frame with refraction, as the walk asks for them round by round.
std::vector<std::vector<RayQuery>> refractedRays(const BenchScene& scene,
                                                 const TraceSettings& settings,
                                                 const FrameGeometry& geometry) {
  std::vector<std::vector<RayQuery>> rounds;
  constexpr int kPacket = 16;
  for (int first = 0; first < scene.scene.probe.lines; first += kPacket) {
    std::vector<LineTrace> traces(kPacket);
    std::vector<LineWalker> walkers;
    for (int i = 0; i < kPacket && first + i < scene.scene.probe.lines; ++i) {
      const LineGeometry line = lineGeometry(scene.scene.probe, first + i);
      walkers.emplace_back(settings, Ray{line.origin, line.direction},
                           geometry.insideAt(line.origin), traces[static_cast<std::size_t>(i)]);
    }
    for (;;) {
      rounds.emplace_back();
      std::vector<LineWalker*> alive;
      for (LineWalker& w : walkers)
        if (w.alive()) {
          rounds.back().push_back(w.query());
          alive.push_back(&w);
        }
      if (alive.empty()) break;
      std::vector<RayCrossings> met(alive.size());
      geometry.crossings(rounds.back(), met);
      for (std::size_t i = 0; i < alive.size(); ++i) alive[i]->advance(met[i]);
    }
    rounds.pop_back();
  }
  return rounds;
}

// Next to a refit and the same rays; bent lines with their echoes linked over the cells.
void hierarchy(benchmark::State& state, bool refraction) {
  const BenchScene scene{Size(state)};
  EffectPlan plan = planEffects(scene.scene);
  plan.refraction = refraction;
  TraceSettings settings(scene.scene, plan, refraction ? EchoCells::links : EchoCells::none);
  if (refraction) settings.media[1].sound_speed_m_s = 1570;
  PlaneRequest request = planeRequest(scene.scene, plan);
  request.intensities = false;
  FrameGeometry geometry(scene.topology);
  BareHierarchy bare(scene);
  geometry.update(scene.frame(0));
  const auto rays = refractedRays(scene, settings, geometry);
  PolarFrame polar;
  overFloor(
      state,
      [&](std::size_t) {
        geometry.update(scene.frame(0));
        traceFrame(geometry, scene.scene.probe, settings, request, polar);
      },
      [&](std::size_t) {
        bare.refit(scene.frame(0));
        benchmark::DoNotOptimize(bare.packets(rays));
      });
}

// Several rays per beam next to as many frames of one ray per line through the hierarchy; without
// refits.
void beams(benchmark::State& state, bool elevation) {
  const BenchScene scene{Size(state)};
  constexpr int kRays = 16;
  Scene asked = scene.scene;
  asked.accuracy.rays_per_beam = kRays;
  asked.effects.elevation = elevation ? Switch::on : Switch::off;
  EffectPlan plan = planEffects(asked);
  plan.refraction = false;
  const TraceSettings settings(asked, plan);
  PlaneRequest request = planeRequest(asked, plan);
  request.intensities = false;
  const BeamRays rays(asked.probe, beamSpread(plan, 1));
  FrameGeometry geometry(scene.topology);
  geometry.update(scene.frame(0));
  PolarFrame polar, single;
  overFloor(
      state,
      [&](std::size_t i) {
        traceBeams(geometry, asked.probe, settings, request, rays, static_cast<int>(i),
                   {0, asked.probe.lines}, polar);
      },
      [&](std::size_t) {
        for (int i = 0; i < kRays; ++i)
          traceFrame(geometry, asked.probe, settings, request, single);
      });
}

BENCHMARK_CAPTURE(hierarchy, straight, false)->Apply(bySize);
BENCHMARK_CAPTURE(hierarchy, refraction, true)->Apply(bySize);
BENCHMARK_CAPTURE(beams, lateral, false)->Apply(bySize);
BENCHMARK_CAPTURE(beams, elevation, true)->Apply(bySize);

}  // namespace
}  // namespace echocine::bench
