#include "signal/log_compression.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/units.h"

namespace echocine {

namespace {

// log2 x = e + 2/ln 2 artanh s with x = 2^e m, m in [sqrt(1/2), sqrt 2), s = (m - 1)/(m + 1). The
// series of artanh is cut after s^9/9: |s| <= 0.1716 leaves under 1.3e-9. Straight-line code that
// vectorises.
inline float log2Inline(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  constexpr std::uint32_t kRootHalf = 0x3f3504f3;  // bits of sqrt(1/2)
  const std::int32_t e = static_cast<std::int32_t>(bits - kRootHalf) >> 23;
  const float m = std::bit_cast<float>(bits - (static_cast<std::uint32_t>(e) << 23));
  const float s = (m - 1) / (m + 1);
  const float s2 = s * s;
  constexpr float kScale = static_cast<float>(2 / std::numbers::ln2);
  const float series =
      s * (1 + s2 * (1.0f / 3 + s2 * (1.0f / 5 + s2 * (1.0f / 7 + s2 * (1.0f / 9)))));
  return static_cast<float>(e) + kScale * series;
}

}  // namespace

float log2Fast(float x) {
  return log2Inline(x);
}

void compressIntensities(std::span<const float> intensities, double reference,
                         double dynamic_range_db, std::span<float> grey) {
  const double per_octave = 10 * std::log10(2.0) / dynamic_range_db;
  const auto scale = static_cast<float>(per_octave);
  const auto offset = static_cast<float>(1 - per_octave * std::log2(reference));
  constexpr float kSmallest = 1.17549435e-38f;
  const float* in = intensities.data();
  float* out = grey.data();
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const float value = offset + scale * log2Inline(in[i]);
    const float limited = std::min(std::max(value, 0.0f), 1.0f);
    out[i] = in[i] >= kSmallest ? limited : 0.0f;
  }
}

double expandGrey(double grey, double reference, double dynamic_range_db) {
  return reference * intensityFromDecibels((grey - 1) * dynamic_range_db);
}

}  // namespace echocine
