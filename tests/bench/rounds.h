#pragma once
// Ratios that hold on a busy machine: what is compared runs in turn, round by round, and is timed
// by the processor time of this process, so that others only disturb by what they leave in the
// caches.

#include <benchmark/benchmark.h>

#include <vector>

#include "bench/cpu_time.h"
#include "core/parallel.h"
#include "metrics/statistics.h"

namespace echocine::bench {

// Frames of a loop that are made together: each finds in the caches what the one before it left, as
// in a run of the program, and not what it is compared with.
inline constexpr std::size_t kTogether = 24;

template <typename Work>
double millisecondsOfEach(std::size_t round, Work&& work) {
  const double ms = millisecondsOf([&] {
    for (std::size_t i = round * kTogether; i < (round + 1) * kTogether; ++i) work(i);
  });
  return ms / kTogether;
}

// Runs floor(i) and ours(i) for some frames in turn on one thread; the first of them changes from
// round to round. Counters: the medians in ms, and over_floor, the median of the rounds' ratios.
template <typename Ours, typename Floor>
void overFloor(benchmark::State& state, Ours&& ours, Floor&& floor) {
  std::vector<double> ours_ms, floor_ms, ratios;
  withThreads(1, [&] {
    std::size_t round = 0;
    for (auto _ : state) {
      double a = 0, b = 0;
      if (round % 2 == 0) a = millisecondsOfEach(round, ours);
      b = millisecondsOfEach(round, floor);
      if (round % 2 == 1) a = millisecondsOfEach(round, ours);
      ++round;
      state.SetIterationTime(1e-3 * kTogether * (a + b));
      ours_ms.push_back(a);
      floor_ms.push_back(b);
      ratios.push_back(a / b);
    }
  });
  state.counters["ours_ms"] = quartilesOf(ours_ms).median;
  state.counters["floor_ms"] = quartilesOf(floor_ms).median;
  state.counters["over_floor"] = quartilesOf(ratios).median;
}

}  // namespace echocine::bench
