#include "trace/layer_stack.h"

#include <algorithm>
#include <cmath>

#include "trace/layer_series.h"
#include "trace/layer_spectrum.h"

namespace echocine {

double cosineSquare(double cos_0, double c_0, double c) {
  const double r = c / c_0;
  return (c_0 - c) / c_0 * (1 + r) + r * r * cos_0 * cos_0;
}

double wholeHalfCycles(double pulse_cycles) {
  return std::max(std::round(2 * pulse_cycles), 1.0) / 2;
}

StackResponse stackResponse(LayerMedium before, double cos_0, std::span<const Layer> layers,
                            LayerMedium after, double frequency_hz, double pulse_cycles) {
  const LayerFaces faces(before, cos_0, layers, after, frequency_hz);
  const double N = wholeHalfCycles(pulse_cycles);
  const std::optional<StackResponse> series = layerSeries(faces, N);
  const StackResponse found = series ? *series : spectrumMean(faces, N);
  return {std::min(found.reflected, 1.0), std::min(found.passed_twice, 1.0)};
}

}  // namespace echocine
