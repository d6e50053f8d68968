#include "frame/white.h"

#include <atomic>
#include <memory>

#include "core/parallel.h"
#include "core/stage_clock.h"
#include "frame/making.h"
#include "frame/simulator.h"
#include "frame/workspace.h"
#include "plan/loop_plan.h"
#include "signal/reference.h"
#include "trace/polar_frame.h"

namespace echocine {

namespace {

struct Traced {
  PolarFrame polar;
  Volumes volumes_ml;
};

}  // namespace

std::optional<double> measureWhite(const Simulator& simulator, std::span<const FrameTime> times,
                                   const Monitor& monitor, const KeepTraced& keep) {
  const Scene& scene = simulator.scene();
  if (scene.signal.reference_intensity) return scene.signal.reference_intensity;
  const EffectPlan& effects = simulator.plan().effects;
  if (!wantsPicture(scene) || !effects.shows()) return 1;
  WhiteMeasure white(scene);
  std::atomic<bool> sees_structures = false;  // in these frames
  const auto work = [&](std::size_t i) -> std::shared_ptr<void> {
    const std::shared_ptr<Workspace> workspace = simulator.workspace();
    Volumes volumes_ml = simulator.make(times[i], {.still = true}, *workspace);
    simulator.clock().time(
        Stage::signal, [&] { white.add(workspace->polar.intensities, workspace->polar.medium); });
    if (workspace->crossings > 0) sees_structures = true;
    if (!keep) return nullptr;
    return std::make_shared<Traced>(
        Traced{std::exchange(workspace->polar, {}), std::move(volumes_ml)});
  };
  const auto collect = [&](std::size_t i, const std::shared_ptr<void>& result) {
    if (auto* traced = static_cast<Traced*>(result.get()))
      keep(times[i].frame, std::move(traced->polar), std::move(traced->volumes_ml));
    monitor.tell({Task::reference, i + 1, times.size()});
  };
  const std::size_t done =
      parallelOrdered(0, times.size(), 2 * static_cast<std::size_t>(threadCount()),
                      monitor.keep_going, work, collect);
  if (done < times.size()) return std::nullopt;
  return sees_structures || !effects.contrast ? white.white() : 1;
}

}  // namespace echocine
