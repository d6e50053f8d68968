#include "render/reference_pass.h"

#include <vector>

#include "core/parallel.h"
#include "frame/reference_frames.h"
#include "signal/reference.h"

namespace echocine {

namespace {

// What a kept frame holds: its planes, by far the most of it.
std::size_t bytesOf(const PolarFrame& polar) {
  std::size_t planes =
      polar.planes.size() + (polar.intensities.empty() ? 0 : 1) + (polar.medium.empty() ? 0 : 1);
  return planes * sizeof(float) * static_cast<std::size_t>(polar.lines) *
         static_cast<std::size_t>(polar.samples);
}

}  // namespace

std::optional<double> findReference(const Simulator& simulator, std::pair<int, int> range,
                                    const Monitor& monitor, KeptFrames& kept) {
  const Scene& scene = simulator.scene();
  const CardiacClock& clock = simulator.cardiacClock();
  if (scene.signal.reference_intensity) return scene.signal.reference_intensity;
  if (!wantsPicture(scene) || !simulator.plan().effects.contrast) return 1;
  // Of the whole loop, also when a part is rendered: parts then have the grey of the whole.
  WhiteMeasure white(scene);
  const std::vector<int> sampled = referenceFrames(clock.frameCount());
  const auto frames = static_cast<int>(sampled.size());
  std::size_t kept_bytes = 0;
  const std::size_t done = parallelOrdered(
      0, static_cast<std::size_t>(frames), 2 * static_cast<std::size_t>(threadCount()),
      monitor.keep_going,
      [&](std::size_t i) -> std::shared_ptr<void> {
        auto frame = std::make_shared<KeptFrame>();
        const std::shared_ptr<Workspace> workspace = simulator.workspace();
        frame->volumes_ml = simulator.traceStill(clock.at(sampled[i]), *workspace);
        simulator.clock().time(Stage::signal, [&] {
          white.add(workspace->polar.intensities, workspace->polar.medium);
        });
        frame->polar = std::move(workspace->polar);
        workspace->polar = {};
        // Only what the signal chain still needs is kept.
        frame->polar.traces.clear();
        frame->polar.cell_echoes = {};
        frame->polar.coherent = {};
        return frame;
      },
      [&](std::size_t i, std::shared_ptr<void> result) {
        auto& frame = *static_cast<KeptFrame*>(result.get());
        const int index = sampled[i];
        if (index >= range.first && index < range.second && !simulator.plan().effects.rolling) {
          kept_bytes += bytesOf(frame.polar);
          if (kept_bytes <= kKeptBytes) kept.emplace(index, std::move(frame));
        }
        monitor.tell({Task::reference, i + 1, static_cast<std::size_t>(frames)});
      });
  if (done < static_cast<std::size_t>(frames)) return std::nullopt;
  if (simulator.work().crossings == 0) return 1;
  return white.white();
}

}  // namespace echocine
