#include "signal/log_compression.h"

#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/lanes.h"
#include "core/units.h"

namespace echocine {

namespace {

// grey = 1 + 10 log10(I / reference) / dynamic range = offset + scale log2 I, limited to 0..1, on
// eight intensities. log2 I = e + 2/ln 2 artanh s with I = 2^e m, m in [sqrt(1/2), sqrt 2),
// s = (m - 1)/(m + 1). The series of artanh is cut after s^7/7: |s| <= 0.1716 leaves under 1.5e-8,
// times 2/ln 2.
class Compression {
 public:
  Compression(double reference, double dynamic_range_db) {
    const double per_octave = 10 * std::log10(2.0) / dynamic_range_db;
    scale_ = static_cast<float>(per_octave);
    offset_ = static_cast<float>(1 - per_octave * std::log2(reference));
    for (int k = 0; k < 4; ++k)
      series_[k] = static_cast<float>(per_octave * 2 / std::numbers::ln2 / (2 * k + 1));
  }

  Floats8 grey(Floats8 intensity) const {
    constexpr std::uint32_t kRootHalf = 0x3f3504f3;  // bits of sqrt(1/2)
    constexpr float kSmallest = std::numeric_limits<float>::min();
    const auto bits = std::bit_cast<Uints8>(intensity);
    const Ints8 e = std::bit_cast<Ints8>(bits - kRootHalf) >> 23;
    const auto m = std::bit_cast<Floats8>(bits - (std::bit_cast<Uints8>(e) << 23));
    const Floats8 s = (m - 1) / (m + 1);
    const Floats8 s2 = s * s;
    const Floats8 value =
        (offset_ + scale_ * __builtin_convertvector(e, Floats8)) +
        s * (series_[0] + s2 * (series_[1] + s2 * (series_[2] + s2 * series_[3])));
    // Numbers from 0 up are in the order of their bits, and those below 0 are negative as bits too.
    const auto as_bits = std::bit_cast<Ints8>(value), white = std::bit_cast<Ints8>(Floats8{} + 1);
    const Ints8 raised = as_bits > 0 ? as_bits : Ints8{};
    const Ints8 limited = raised > white ? white : raised;
    return std::bit_cast<Floats8>(limited & (intensity >= kSmallest));
  }

 private:
  float scale_, offset_;
  float series_[4];
};

}  // namespace

void compressIntensities(std::span<const float> intensities, double reference,
                         double dynamic_range_db, std::span<float> grey) {
  const Compression compression(reference, dynamic_range_db);
  std::size_t i = 0;
  for (; i + kFloatLanes <= grey.size(); i += kFloatLanes)
    store(compression.grey(lanesAt(&intensities[i])), &grey[i]);
  if (i == grey.size()) return;
  Floats8 rest{};
  std::memcpy(&rest, &intensities[i], (grey.size() - i) * sizeof(float));
  storeSome(compression.grey(rest), grey.size() - i, &grey[i]);
}

}  // namespace echocine
