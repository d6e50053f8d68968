#include "signal/log_compression.h"

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/lanes.h"
#include "core/units.h"

namespace echocine {

namespace {

// log2 x = e + 2/ln 2 artanh s with x = 2^e m, m in [sqrt(1/2), sqrt 2), s = (m - 1)/(m + 1). The
// series of artanh is cut after s^7/7: |s| <= 0.1716 leaves under 1.5e-8, times 2/ln 2.
Lanes log2Of(Lanes x) {
  const auto bits = std::bit_cast<IntLanes>(x);
  constexpr std::int32_t kRootHalf = 0x3f3504f3;  // bits of sqrt(1/2)
  const IntLanes e = (bits - kRootHalf) >> 23;
  const auto m = std::bit_cast<Lanes>(bits - (e << 23));
  const Lanes s = (m - 1) / (m + 1);
  const Lanes s2 = s * s;
  constexpr float kScale = static_cast<float>(2 / std::numbers::ln2);
  const Lanes series = s * (1 + s2 * (1.0f / 3 + s2 * (1.0f / 5 + s2 * (1.0f / 7))));
  return __builtin_convertvector(e, Lanes) + kScale * series;
}

// grey = 1 + 10 log10(I / reference) / dynamic range = offset + scale log2 I, limited to 0..1.
struct Compression {
  float scale, offset;

  Lanes grey(Lanes intensity) const {
    constexpr float kSmallest = std::numeric_limits<float>::min();
    const Lanes value = offset + scale * log2Of(intensity), none{};
    const Lanes raised = value > none ? value : none;
    const Lanes limited = raised < 1 ? raised : none + 1;
    return std::bit_cast<Lanes>(std::bit_cast<IntLanes>(limited) & (intensity >= kSmallest));
  }
};

}  // namespace

float log2Fast(float x) {
  return log2Of(Lanes{} + x)[0];
}

void compressIntensities(std::span<const float> intensities, double reference,
                         double dynamic_range_db, std::span<float> grey) {
  const double per_octave = 10 * std::log10(2.0) / dynamic_range_db;
  const Compression compression{static_cast<float>(per_octave),
                                static_cast<float>(1 - per_octave * std::log2(reference))};
  std::size_t i = 0;
  for (; i + kLanes <= grey.size(); i += kLanes)
    storeLanes(compression.grey(lanesAt(&intensities[i])), kLanes, &grey[i]);
  if (i == grey.size()) return;
  Lanes rest{};
  std::memcpy(&rest, &intensities[i], (grey.size() - i) * sizeof(float));
  storeLanes(compression.grey(rest), grey.size() - i, &grey[i]);
}

double expandGrey(double grey, double reference, double dynamic_range_db) {
  return reference * intensityFromDecibels((grey - 1) * dynamic_range_db);
}

}  // namespace echocine
