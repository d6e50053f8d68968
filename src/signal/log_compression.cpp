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
Floats8 log2Of(Floats8 x) {
  const auto bits = std::bit_cast<Ints8>(x);
  constexpr std::int32_t kRootHalf = 0x3f3504f3;  // bits of sqrt(1/2)
  const Ints8 e = (bits - kRootHalf) >> 23;
  const auto m = std::bit_cast<Floats8>(bits - (e << 23));
  const Floats8 s = (m - 1) / (m + 1);
  const Floats8 s2 = s * s;
  constexpr float kScale = static_cast<float>(2 / std::numbers::ln2);
  const Floats8 series = s * (1 + s2 * (1.0f / 3 + s2 * (1.0f / 5 + s2 * (1.0f / 7))));
  return __builtin_convertvector(e, Floats8) + kScale * series;
}

// grey = 1 + 10 log10(I / reference) / dynamic range = offset + scale log2 I, limited to 0..1.
struct Compression {
  float scale, offset;

  Floats8 grey(Floats8 intensity) const {
    constexpr float kSmallest = std::numeric_limits<float>::min();
    const Floats8 value = offset + scale * log2Of(intensity), none{};
    const Floats8 raised = value > none ? value : none;
    const Floats8 limited = raised < 1 ? raised : none + 1;
    return std::bit_cast<Floats8>(std::bit_cast<Ints8>(limited) & (intensity >= kSmallest));
  }
};

}  // namespace

float log2Fast(float x) {
  return log2Of(Floats8{} + x)[0];
}

void compressIntensities(std::span<const float> intensities, double reference,
                         double dynamic_range_db, std::span<float> grey) {
  const double per_octave = 10 * std::log10(2.0) / dynamic_range_db;
  const Compression compression{static_cast<float>(per_octave),
                                static_cast<float>(1 - per_octave * std::log2(reference))};
  std::size_t i = 0;
  for (; i + kFloatLanes <= grey.size(); i += kFloatLanes)
    store(compression.grey(lanesAt(&intensities[i])), &grey[i]);
  if (i == grey.size()) return;
  Floats8 rest{};
  std::memcpy(&rest, &intensities[i], (grey.size() - i) * sizeof(float));
  storeSome(compression.grey(rest), grey.size() - i, &grey[i]);
}

double expandGrey(double grey, double reference, double dynamic_range_db) {
  return reference * intensityFromDecibels((grey - 1) * dynamic_range_db);
}

}  // namespace echocine
