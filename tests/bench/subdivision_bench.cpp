// Loop subdivision of a ball to 138,882 vertices, and its limit normals, next to the bare sparse
// product. Each round times all of them one after the other, so that their ratios (medians over the
// rounds, counter `over_bare`) hold on a machine that others use as well.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>

#include "bench/floor/bare_product.h"
#include "metrics/statistics.h"
#include "motion/subdivision/limit_normals.h"
#include "motion/subdivision/subdivision.h"

namespace echocine::bench {
namespace {

constexpr int kLevels = 3;

struct Workload {
  support::Mesh mesh = support::uvSphere(32, 70, 0.03);
  Subdivision subdivision{mesh.triangles, count(), {}, kLevels, {}};
  LimitNormals limit{mesh.triangles, count(), {}, kLevels, {}};
  BareProduct bare{mesh, kLevels};
  std::vector<Vec3f> control, out{subdivision.vertexCount()}, normals{limit.normalCount()};

  Workload() {
    for (const Vec3d& p : mesh.points) control.push_back(toFloat(p));
  }
  std::uint32_t count() const { return static_cast<std::uint32_t>(mesh.points.size()); }
};

template <typename Work>
double millisecondsOf(Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

enum class Row { subdivision, normals };

void overBare(benchmark::State& state, Row row) {
  Workload w;
  std::vector<double> ours, bare;
  for (auto _ : state) {
    const double scalar = millisecondsOf([&] { w.bare.scalar(w.control, w.out); });
    benchmark::DoNotOptimize(w.out.data());
    const double vectorised = millisecondsOf([&] { w.bare.vectorised(w.control, w.out); });
    benchmark::DoNotOptimize(w.out.data());
    bare.push_back(std::min(scalar, vectorised));
    ours.push_back(millisecondsOf([&] {
      if (row == Row::subdivision)
        w.subdivision.apply(w.control, w.out);
      else
        w.limit.apply(w.control, w.normals);
    }));
    benchmark::DoNotOptimize(w.out.data());
    benchmark::DoNotOptimize(w.normals.data());
    state.SetIterationTime(1e-3 * ours.back());
  }
  state.counters["vertices"] = static_cast<double>(w.out.size());
  state.counters["weights"] = static_cast<double>(w.bare.weights());
  state.counters["bare_ms"] = quartilesOf(bare).median;
  state.counters["ours_ms"] = quartilesOf(ours).median;
  state.counters["over_bare"] = quartilesOf(ours).median / quartilesOf(bare).median;
}

BENCHMARK_CAPTURE(overBare, subdivision, Row::subdivision)
    ->UseManualTime()
    ->Iterations(200)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(overBare, limit_normals, Row::normals)
    ->UseManualTime()
    ->Iterations(200)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace echocine::bench
