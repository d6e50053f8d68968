// The cost of each effect of a scanner's picture: frames of the shipped heart with one effect more
// than a bare frame, next to that frame. The bare frame has the look "scanner" without artefacts.

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <string>

#include "bench/rounds.h"
#include "frame/simulator.h"
#include "motion/cycle/cardiac_clock.h"
#include "scene/scene_reader.h"
#include "support/paths.h"

namespace echocine::bench {
namespace {

constexpr int kEffectRounds = 25;

struct AddedEffect {
  const char* name;
  void (*add)(Scene& scene, const Scene& scanner);
};

// Levels of artefacts are the scanner's throughout.
constexpr AddedEffect kAdded[] = {
    {"dropout", [](Scene& s, const Scene&) { s.artefacts.dropout = true; }},
    {"acoustic_window", [](Scene& s, const Scene&) { s.artefacts.acoustic_window = true; }},
    {"shading", [](Scene& s, const Scene&) { s.artefacts.shading = true; }},
    {"lung", [](Scene& s, const Scene&) { s.artefacts.lung = true; }},
    {"haze", [](Scene& s, const Scene&) { s.artefacts.haze = true; }},
    {"reverberation", [](Scene& s, const Scene&) { s.artefacts.reverberation = true; }},
    {"clutter", [](Scene& s, const Scene&) { s.artefacts.clutter = true; }},
    {"noise", [](Scene& s, const Scene&) { s.artefacts.noise = true; }},
    {"all artefacts", [](Scene& s, const Scene& scanner) { s.artefacts = scanner.artefacts; }},
    {"harmonic", [](Scene& s, const Scene&) { s.signal.harmonic = true; }},
    {"edge_enhancement", [](Scene& s, const Scene&) { s.signal.edge_enhancement = 0.5; }},
};

// Effects of the bare frame itself: that frame next to one without the effect.
constexpr AddedEffect kRemoved[] = {
    {"downshift", [](Scene& s, const Scene&) { s.signal.downshift = false; }},
    {"receive_aperture", [](Scene& s, const Scene&) { s.signal.receive_f_number = 0; }},
    {"heterogeneity", [](Scene& s, const Scene&) { s.speckle.heterogeneity_db = 0; }},
    {"anisotropy", [](Scene& s, const Scene&) { s.speckle.anisotropy_db = 0; }},
    {"trabeculae", [](Scene& s, const Scene&) { s.trabeculae.deviation_m = 0; }},
    {"leaflets", [](Scene& s, const Scene&) { s.leaflets.thickness_m = s.leaflets.cusp_m = 0; }},
    {"chordae", [](Scene& s, const Scene&) { s.leaflets.chordae_m = 0; }},
    {"annulus", [](Scene& s, const Scene&) { s.leaflets.annulus_m = 0; }},
    {"elevation slices", [](Scene& s, const Scene&) { s.accuracy.elevation_slices = 1; }},
    {"beam profile", [](Scene& s, const Scene&) { s.signal.beam_width = BeamWidth::focused; }},
    {"speckle", [](Scene& s, const Scene&) { s.speckle.on = false; }},
};

void switchOff(ArtefactSettings& a) {
  a.dropout = a.acoustic_window = a.shading = a.lung = a.haze = a.reverberation = a.clutter =
      a.noise = false;
}

// Sum over some frames of the least time of each in all rounds: what other jobs on the machine
// disturb least. Each frame of a round follows another one, as in a run of the program.
class LeastTime {
 public:
  explicit LeastTime(const Simulator& simulator)
      : simulator_(simulator), workspace_(simulator.workspace()) {}

  // Milliseconds of this round.
  double round() {
    double sum_ms = 0;
    const CardiacClock& clock = simulator_.cardiacClock();
    for (std::size_t i = 0; i < least_ms_.size(); ++i) {
      const FrameTime time =
          clock.at(static_cast<int>(i) * clock.frameCount() / static_cast<int>(least_ms_.size()));
      const double ms = millisecondsOf([&] {
        benchmark::DoNotOptimize(simulator_.trace(time, *workspace_));
        benchmark::DoNotOptimize(
            simulator_.picture(simulator_.referenceIntensity(), time, *workspace_, true)
                .pixels.data());
      });
      least_ms_[i] = std::min(least_ms_[i], ms);
      sum_ms += ms;
    }
    return sum_ms;
  }
  double ofOneFrame() const {
    return std::accumulate(least_ms_.begin(), least_ms_.end(), 0.0) /
           static_cast<double>(least_ms_.size());
  }

 private:
  const Simulator& simulator_;
  std::shared_ptr<Workspace> workspace_;
  std::array<double, 8> least_ms_ = filled();

  static std::array<double, 8> filled() {
    std::array<double, 8> out{};
    out.fill(std::numeric_limits<double>::infinity());
    return out;
  }
};

// Denormal numbers count as 0 in this thread. Without noise and lung's reverberations, intensities
// in lung become denormal, which processors compute slowly: 4 ms of a bare frame.
class NoDenormals {
 public:
#if defined(__SSE__)
  NoDenormals() : before_(_mm_getcsr()) {
    _mm_setcsr(before_ | kFlushToZero | kDenormalsAreZero);
  }
  ~NoDenormals() {
    _mm_setcsr(before_);
  }

 private:
  static constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x40;
  unsigned before_;
#endif
};

// Counters: added, the time of the effect over the bare frame's; bare_ms, of the bare frame.
void addedTime(benchmark::State& state, const Simulator& more, const Simulator& less,
               bool more_is_bare) {
  LeastTime with(more), without(less);
  withThreads(1, [&] {
    [[maybe_unused]] const NoDenormals none;
    for (auto _ : state) state.SetIterationTime(1e-3 * (with.round() + without.round()));
  });
  const double bare_ms = more_is_bare ? with.ofOneFrame() : without.ofOneFrame();
  state.counters["bare_ms"] = bare_ms;
  state.counters["added"] = (with.ofOneFrame() - without.ofOneFrame()) / bare_ms;
}

const Scene& scannerScene() {
  static const Scene scene =
      readScene(std::string(support::kSourceDir) + "/examples/beating_heart/scene.toml");
  return scene;
}

const Simulator& bareSimulator() {
  static const std::unique_ptr<const Simulator> simulator = [] {
    Scene bare = scannerScene();
    switchOff(bare.artefacts);
    std::unique_ptr<const Simulator> made;
    withThreads(1, [&] { made = std::make_unique<const Simulator>(bare); });
    return made;
  }();
  return *simulator;
}

void effect(benchmark::State& state, const AddedEffect& changed, bool removed) {
  Scene scene = bareSimulator().scene();
  changed.add(scene, scannerScene());
  std::optional<Simulator> other;
  withThreads(1, [&] {
    if (scene.trabeculae.deviation_m == bareSimulator().scene().trabeculae.deviation_m)
      other.emplace(scene, bareSimulator().sharedMotion());
    else
      other.emplace(scene);
  });
  if (removed)
    addedTime(state, bareSimulator(), *other, true);
  else
    addedTime(state, *other, bareSimulator(), false);
}

const bool kRegistered = [] {
  const auto registerAll = [](const auto& effects, bool removed) {
    for (const AddedEffect& changed : effects)
      benchmark::RegisterBenchmark(
          (std::string("effect/") + changed.name).c_str(),
          [&changed, removed](benchmark::State& state) { effect(state, changed, removed); })
          ->UseManualTime()
          ->Iterations(kEffectRounds)
          ->Unit(benchmark::kMillisecond);
  };
  registerAll(kAdded, false);
  registerAll(kRemoved, true);
  return true;
}();

}  // namespace
}  // namespace echocine::bench
