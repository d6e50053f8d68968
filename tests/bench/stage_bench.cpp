// Stages next to their floors, bare loops without rules. Sizes: triangles / lines / samples.

#include "bench/floor/bare_files.h"
#include "bench/floor/bare_motion.h"
#include "bench/floor/bare_signal.h"
#include "bench/floor/bare_slice.h"
#include "bench/rounds.h"
#include "bench/sizes.h"
#include "motion/mesh/surface_measure.h"
#include "motion/surfaces/mesh_motion.h"
#include "output/exr_stack.h"
#include "scene/scan_geometry.h"
#include "signal/log_compression.h"
#include "signal/scan_conversion.h"
#include "signal/signal_chain.h"
#include "trace/trace_frame.h"
#include "video/cine_writer.h"

namespace echocine::bench {
namespace {

void keyframes(benchmark::State& state) {
  const BenchScene scene{Size(state)};
  BareMotion bare(scene);
  SurfaceFrame frame = scene.frames[0];
  overFloor(
      state,
      [&](std::size_t i) {
        for (std::size_t s = 0; s < scene.motion.size(); ++s)
          scene.motion[s].at(BenchScene::phase(i), frame.positions_m[s]);
      },
      [&](std::size_t i) { bare.blend(i); });
}

void volumes(benchmark::State& state) {
  const BenchScene scene{Size(state)};
  BareMotion bare(scene);
  bare.blend(0);
  std::vector<VolumeSum> ours;
  for (const SurfaceTopology& s : scene.topology) ours.emplace_back(s.triangles);
  overFloor(
      state,
      [&](std::size_t i) {
        for (std::size_t s = 0; s < ours.size(); ++s)
          benchmark::DoNotOptimize(ours[s].of(scene.frame(i).positions_m[s]));
      },
      [&](std::size_t) { benchmark::DoNotOptimize(bare.volumes()); });
}

void slice(benchmark::State& state) {
  const BenchScene scene{Size(state)};
  BareSlice bare(scene);
  PlaneSlice ours(scene.topology, scene.scene.probe);
  overFloor(
      state, [&](std::size_t i) { ours.update(scene.frame(i)); },
      [&](std::size_t i) { bare.slice(scene.frame(i)); });
}

// Walk, echoes and samples.
void trace(benchmark::State& state, bool cells) {
  const BenchScene scene{Size(state)};
  BareSlice bare(scene);
  PlaneSlice ours(scene.topology, scene.scene.probe);
  const EffectPlan plan = planEffects(scene.scene);
  const TraceSettings settings(scene.scene, plan, cells ? EchoCells::contours : EchoCells::none);
  PlaneRequest request = planeRequest(scene.scene, plan);
  request.intensities = false;
  PolarFrame polar;
  overFloor(
      state,
      [&](std::size_t i) {
        if (i == 0) ours.update(scene.frame(0));
        traceFrame(ours, scene.scene.probe, settings, request, polar);
      },
      [&](std::size_t i) {
        if (i == 0) bare.slice(scene.frame(0));
        benchmark::DoNotOptimize(bare.fill().data());
      });
}

// A plane as the tracer leaves it.
struct Traced {
  BenchScene scene;
  EffectPlan plan;
  SignalChain chain;
  PolarFrame polar;

  explicit Traced(const Size& size)
      : scene(size), plan(planEffects(scene.scene)), chain(scene.scene, plan) {
    PlaneSlice slice(scene.topology, scene.scene.probe);
    slice.update(scene.frame(0));
    const TraceSettings settings(scene.scene, plan, EchoCells::contours);
    traceFrame(slice, scene.scene.probe, settings, planeRequest(scene.scene, plan), polar);
  }
};
constexpr float kStageReference = 1e-6f, kStageRange_db = 60;

void beamAverage(benchmark::State& state) {
  Traced t{Size(state)};
  BareAverage bare(t.scene.scene);
  const BeamAverage ours(t.scene.scene.probe, t.scene.scene.signal);
  std::vector<float> plane = t.polar.intensities.values, bare_plane = plane;
  overFloor(
      state, [&](std::size_t) { ours.apply(plane); }, [&](std::size_t) { bare.run(bare_plane); });
}

void logCompression(benchmark::State& state) {
  const Traced t{Size(state)};
  BareLog bare;
  cv::Mat grey;
  std::vector<float> out(t.polar.intensities.size());
  overFloor(
      state,
      [&](std::size_t) {
        compressIntensities(t.polar.intensities, kStageReference, kStageRange_db, out);
      },
      [&](std::size_t) {
        bare.run(t.polar.intensities.values, kStageReference, kStageRange_db, grey);
      });
}

void scanConversion(benchmark::State& state) {
  Traced t{Size(state)};
  const Greys greys = t.chain.compress(std::move(t.polar.intensities), kStageReference);
  std::vector<std::uint8_t> grey;
  for (const float g : greys) grey.push_back(static_cast<std::uint8_t>(255 * g + 0.5f));
  BareScanConversion bare(t.scene.scene, t.chain.geometry());
  GreyImage image;
  overFloor(
      state, [&](std::size_t) { t.chain.picture(greys, image); },
      [&](std::size_t) { benchmark::DoNotOptimize(bare.run(grey.data()).data()); });
}

// A picture of 112 x 112, each pixel the mean over its area, next to one of values at the centres.
void smallPicture(benchmark::State& state) {
  Traced t{Size(state)};
  constexpr int kSize = 112;
  Scene& scene = t.scene.scene;
  scene.output.width = scene.output.height = kSize;
  const PictureGeometry geometry = pictureGeometry(scene);
  const ScanConverter ours(scene.probe, geometry, kSize, kSize, GreyCurve(),
                           ScanConverter::averagedOver(scene, geometry)),
      centres(scene.probe, geometry, kSize, kSize, GreyCurve());
  const Greys greys = t.chain.compress(std::move(t.polar.intensities), kStageReference);
  GreyImage image;
  overFloor(
      state, [&](std::size_t) { ours.convert(greys.values, image); },
      [&](std::size_t) { centres.convert(greys.values, image); });
}

void exr(benchmark::State& state) {
  const Traced t{Size(state)};
  const support::TempFolder folder;
  const ExrStack stack(folder.path(), t.scene.scene, std::string(64, '0'), 1);
  BareFiles bare(t.scene.scene);
  overFloor(
      state,
      [&](std::size_t i) {
        stack.write({static_cast<int>(i), 0, 0, 0}, {{Channel::y, t.polar.intensities, {}}});
      },
      [&](std::size_t i) { bare.exr(t.polar.intensities.values, i); });
}

// Compressions and pixels over uncompressed floats: over_floor in time, size in bytes.
void exrKinds(benchmark::State& state) {
  const Traced t{Size{}};
  Scene scene = t.scene.scene;
  scene.output.exr_compression = static_cast<ExrCompression>(state.range(0));
  scene.output.exr_pixel = static_cast<ExrPixel>(state.range(1));
  const support::TempFolder folder, plain_folder;
  const ExrStack stack(folder.path(), scene, std::string(64, '0'), 1);
  const ExrStack plain(plain_folder.path(), t.scene.scene, std::string(64, '0'), 1);
  const auto write = [&](const ExrStack& to, std::size_t i) {
    to.write({static_cast<int>(i), 0, 0, 0}, {{Channel::y, t.polar.planes.at(Channel::y), {}}});
  };
  overFloor(
      state, [&](std::size_t i) { write(stack, i); }, [&](std::size_t i) { write(plain, i); });
  const auto bytes = [](const support::TempFolder& of) {
    return static_cast<double>(std::filesystem::file_size(of / ExrStack::fileName(0)));
  };
  state.counters["size"] = bytes(folder) / bytes(plain_folder);
}

void jpeg(benchmark::State& state) {
  Traced t{Size(state)};
  GreyImage image;
  t.chain.picture(t.chain.compress(std::move(t.polar.intensities), kStageReference), image);
  const support::TempFolder folder;
  const OutputSettings& o = t.scene.scene.output;
  CineWriter writer(folder / "cine.avi", o, 50);
  BareFiles bare(t.scene.scene);
  overFloor(
      state, [&](std::size_t) { writer.add(encodeCineFrame(image, o.codec, o.jpeg_quality)); },
      [&](std::size_t) { bare.jpeg(image.pixels, o.jpeg_quality); });
}

BENCHMARK(keyframes)->Apply(bySize);
BENCHMARK(volumes)->Apply(bySize);
BENCHMARK(slice)->Apply(byBoth);
BENCHMARK_CAPTURE(trace, centres, false)->Apply(byBoth);
BENCHMARK_CAPTURE(trace, cells, true)->Apply(byBoth);
BENCHMARK(beamAverage)->Apply(byPlane);
BENCHMARK(logCompression)->Apply(byPlane);
BENCHMARK(scanConversion)->Apply(byPlane);
BENCHMARK(smallPicture)->Apply(byPlane);
BENCHMARK(exr)->Apply(byPlane)->Iterations(3);
BENCHMARK(jpeg)->Apply(byPlane);
BENCHMARK(exrKinds)->ArgsProduct({{0, 1, 2, 3, 4, 5}, {0, 1}})->Apply([](auto* b) {
  rounds(b, 1);
});

}  // namespace
}  // namespace echocine::bench
