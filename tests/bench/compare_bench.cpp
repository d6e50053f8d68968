// One call of the discrepancy on a frame of 256 x 1024 against a frame of a real loop, as an
// optimiser makes it, over its floor: the edges of the frame, which it cannot do without.

#include <cmath>

#include "bench/rounds.h"
#include "compare/frame_discrepancy.h"
#include "core/hash_random.h"
#include "support/plain_scene.h"

namespace echocine::bench {
namespace {

using namespace echo;
using namespace compare;

// A loop of moving rings under noise, its sector that of the probe.
EchoLoop ringLoop(const Probe& probe) {
  EchoLoop loop;
  loop.video.name = "rings";
  loop.video.width = 640;
  loop.video.height = 480;
  loop.metres_per_pixel = probe.max_depth_m / 470;
  loop.find.sector = {320, 4, probe.first_angle_rad, probe.last_angle_rad, 8, 470};
  for (int f = 0; f < 8; ++f) {
    PixelPlane picture(640 * 480);
    for (int y = 0; y < 480; ++y)
      for (int x = 0; x < 640; ++x)
        if (loop.sector().contains(x + 0.5, y + 0.5)) {
          const double r = std::hypot(x - 320.0, y - 240.0 - f);
          const double noise = uniformFromHash(hashOf(f, x, y));
          picture[static_cast<std::size_t>(y * 640 + x)] =
              static_cast<std::uint8_t>(100 + 80 * std::sin(r / 9) + 60 * noise);
        }
    loop.video.frames.push_back(picture);
  }
  loop.overlay.assign(640 * 480, 0);
  loop.video.coloured.assign(640 * 480, 0);
  return loop;
}

void discrepancy(benchmark::State& state) {
  Scene scene = support::plainScene({support::medium("tissue", 1050, 1584, 14, 1e-3)});
  scene.probe.lines = 256;
  scene.probe.samples = 1024;
  const EchoLoop real = ringLoop(scene.probe);
  const FrameDiscrepancy measure(real, scene.probe);
  std::vector<float> grey(256 * 1024);
  for (std::size_t i = 0; i < grey.size(); ++i)
    grey[i] = static_cast<float>(uniformFromHash(hashOf(i, 1)));
  const BeamGrid grid{.lines = 256,
                      .samples = 341,
                      .first_rad = scene.probe.first_angle_rad,
                      .last_rad = scene.probe.last_angle_rad,
                      .near = 0,
                      .far = scene.probe.max_depth_m,
                      .metric = true};
  const std::vector<float> weights(grid.size(), 1.0f);
  const WallEdges edges(grid, weights);
  const std::span<const float> part(grey.data(), grid.size());
  overFloor(
      state,
      [&](std::size_t i) { benchmark::DoNotOptimize(measure(static_cast<int>(i % 8), grey)); },
      [&](std::size_t) { benchmark::DoNotOptimize(edges(part)); });
}

BENCHMARK(discrepancy)->UseManualTime()->Iterations(4)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace echocine::bench
