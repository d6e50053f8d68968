#include "trace/layer_echoes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace echocine {

double pulseCorrelation(double x, double N) {
  const double X = 2 * std::numbers::pi * N;
  if (x >= X) return 0;
  return (1 - x / X) * std::cos(x) + std::sin(x) / X;
}

LayerEchoes::Together LayerEchoes::together(double pulse_cycles, bool losses) const {
  std::array<double, 8> energy{};  // of each face, with half of what each pair adds
  double S = 0, P = 1, positive = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    double sum = faces_[i].amplitude;
    for (std::size_t j = 0; j < count_; ++j)
      if (j != i)
        sum += faces_[j].amplitude *
               pulseCorrelation(std::abs(faces_[i].phase - faces_[j].phase), pulse_cycles);
    const double own = faces_[i].amplitude * sum;
    S += own;
    energy[i] = std::max(own, 0.0);
    positive += energy[i];
    P *= 1 - faces_[i].amplitude * faces_[i].amplitude;
  }
  S = std::max(S, 0.0);  // rounding
  const double between = losses && S + P > 0 ? S + P : 1;
  Together result;
  for (std::size_t i = 0; i < count_; ++i) {
    // A pair's share may leave a weak face below nothing: the others bear it.
    const double r2 = faces_[i].amplitude * faces_[i].amplitude;
    const double share = positive > 0 ? energy[i] * (S / positive) : 0;
    result.scale[i] = r2 > 0 ? share / r2 / between : 0;
  }
  result.through = losses && S + P > 0 ? P / (S + P) : 1;
  return result;
}

}  // namespace echocine
