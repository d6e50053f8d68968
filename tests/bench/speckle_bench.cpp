// Scatterers per resolution cell: what they cost, and what the statistics of the speckle come to.
// Rayleigh: envelope's mean over its deviation 1.913, mean square of intensity over its squared
// mean 2. Cells, half maxima of the intensity's autocorrelation, over those of the point spread.

#include <benchmark/benchmark.h>

#include "bench/rounds.h"
#include "core/parallel.h"
#include "metrics/statistics.h"
#include "scene/scan_geometry.h"
#include "support/speckle_bed.h"

namespace echocine::bench {
namespace {

using support::correlation;
using support::widthAtHalf;
using support::Window;

void speckleDensity(benchmark::State& state) {
  support::SpeckleBed bed(ProbeKind::phased, 250, 1024, 0.002, 0.16);
  bed.settings.per_cell = static_cast<double>(state.range(0));
  std::vector<double> times_ms;
  double n = 0, envelope = 0, intensity = 0, square = 0;
  constexpr int kLags = 12;
  std::vector<double> along(kLags), across(kLags);
  for (auto _ : state) {
    ++bed.settings.seed;
    withThreads(1, [&] {
      const Speckle speckle = bed.speckle();
      std::vector<float> picture = bed.picture(speckle);  // memory is there from now on
      times_ms.push_back(millisecondsOf([&] { picture = bed.picture(speckle); }));
      for (const float v : picture) {
        const double i = v;
        n += 1;
        envelope += std::sqrt(i);
        intensity += i;
        square += i * i;
      }
      const Window w{8, 230, 8, 1004};
      for (int lag = 0; lag < kLags; ++lag) {
        const auto at = static_cast<std::size_t>(lag);
        along[at] += correlation(picture, picture, 1024, w, 0, lag);
        across[at] += correlation(picture, picture, 1024, w, lag, 0);
      }
    });
    state.SetIterationTime(1e-3 * times_ms.back());
  }
  const double mean_envelope = envelope / n, mean = intensity / n;
  state.counters["ours_ms"] = quartilesOf(times_ms).median;
  state.counters["envelope_snr"] = mean_envelope / std::sqrt(mean - mean_envelope * mean_envelope);
  state.counters["second_moment"] = square / n / (mean * mean);
  state.counters["mean"] = mean;
  for (std::vector<double>* by_lag : {&along, &across}) {
    const double whole = by_lag->front();
    for (double& c : *by_lag) c /= whole;
  }
  const PointSpread spread(bed.probe, 2);
  constexpr double kDepth_m = 0.1;  // the angle is the same at every one
  state.counters["axial_over_theory"] =
      widthAtHalf(along) * bed.probe.sampleSpacing() / spread.axial_width_m;
  state.counters["lateral_over_theory"] =
      widthAtHalf(across) * lineSpacing(bed.probe, kDepth_m) / spread.lateralWidth(kDepth_m);
}

BENCHMARK(speckleDensity)
    ->Arg(1)
    ->Arg(2)
    ->Arg(3)
    ->Arg(5)
    ->Arg(10)
    ->Arg(20)
    ->UseManualTime()
    ->Iterations(7)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace echocine::bench
