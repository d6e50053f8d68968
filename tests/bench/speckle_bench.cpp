// Scatterers per resolution cell: what they cost, and what the statistics of the speckle come to.
// Rayleigh: envelope's mean over its deviation 1.913, mean square of intensity over its squared
// mean 2.

#include <benchmark/benchmark.h>

#include "bench/rounds.h"
#include "core/parallel.h"
#include "metrics/statistics.h"
#include "support/speckle_bed.h"

namespace echocine::bench {
namespace {

void speckleDensity(benchmark::State& state) {
  support::SpeckleBed bed(ProbeKind::phased, 250, 1024, 0.002, 0.16);
  bed.settings.per_cell = static_cast<double>(state.range(0));
  std::vector<double> times_ms;
  double n = 0, envelope = 0, intensity = 0, square = 0;
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
    });
    state.SetIterationTime(1e-3 * times_ms.back());
  }
  const double mean_envelope = envelope / n, mean = intensity / n;
  state.counters["ours_ms"] = quartilesOf(times_ms).median;
  state.counters["envelope_snr"] = mean_envelope / std::sqrt(mean - mean_envelope * mean_envelope);
  state.counters["second_moment"] = square / n / (mean * mean);
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
