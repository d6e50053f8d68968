#pragma once
// The sizes that stages are timed at: triangles, lines, samples.

#include <benchmark/benchmark.h>

namespace echocine::bench {

inline void rounds(benchmark::internal::Benchmark* b, int count) {
  b->UseManualTime()->Iterations(count)->Unit(benchmark::kMillisecond);
}
inline void bySize(benchmark::internal::Benchmark* b) {
  for (const int triangles : {5000, 50000, 500000}) b->Args({triangles, 256, 1024});
  rounds(b, 12);
}
inline void byPlane(benchmark::internal::Benchmark* b) {
  for (const int lines : {128, 256, 512})
    for (const int samples : {512, 1024, 2048}) b->Args({5000, lines, samples});
  rounds(b, 12);
}
inline void byBoth(benchmark::internal::Benchmark* b) {
  bySize(b);
  for (const int lines : {128, 512}) b->Args({50000, lines, 1024});
  for (const int samples : {512, 2048}) b->Args({50000, 256, samples});
}

}  // namespace echocine::bench
