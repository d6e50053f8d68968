#include "speckle/speckle.h"

#include <algorithm>

namespace echocine {

Speckle::Speckle(const Probe& probe, double pulse_cycles, const SpeckleSettings& settings,
                 const Material& material)
    : settings_(settings),
      lines_(probe.lines),
      samples_(probe.samples),
      spread_(probe, pulse_cycles),
      view_(probe, spread_),
      gaussian_(settings.seed),
      scatterers_(probe, spread_, view_, settings, material),
      splatter_(probe, spread_),
      ratio_(probe, spread_, view_, settings.smoothing_m) {}

double Speckle::farthestAcross_m() const {
  double farthest_m = 0;
  for (const ScattererBatch& batch : scatterers_.batches())
    farthest_m = std::max({farthest_m, static_cast<double>(-batch.low_m.y),
                           static_cast<double>(batch.low_m.y + batch.edge_m)});
  return farthest_m;
}

void Speckle::addUp(const MaterialFrame& tissue, double time_s, EchoSums& sums) const {
  SplatQueue queue;
  for (const ScattererBatch& batch : scatterers_.batches()) {
    const BeamCube cube = view_.cubeOf(tissue.corners(batch.group, batch.low_m, batch.edge_m));
    if (!view_.sees(cube)) continue;
    splatter_.add(cube, scatterers_, batch,
                  mixAt(gaussian_, batch.pattern, time_s,
                        batch.blood ? settings_.blood_time_s : settings_.tissue_time_s),
                  queue, sums);
  }
  queue.flush(sums);
}

void Speckle::apply(const MaterialFrame& tissue, double time_s,
                    std::span<float> intensities) const {
  thread_local EchoSums sums;
  thread_local CoherentRatio::Rows rows;
  sums.resize(lines_, samples_);
  addUp(tissue, time_s, sums);
  ratio_.apply(sums, rows, intensities);
}

}  // namespace echocine
