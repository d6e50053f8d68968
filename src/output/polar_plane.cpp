#include "output/polar_plane.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "core/check.h"

namespace echocine {
namespace {

// Comparisons with a value that is not a number are false. `&` in place of `&&` leaves no branch,
// so that the loop over a plane becomes vector instructions.
bool isUsable(float value) {
  return (value >= 0.0f) & (value <= std::numeric_limits<float>::max());
}

// A block reads kBlockLines cache lines at a stride that is often a power of two and so falls into
// one set of the first-level cache: more than eight would evict each other.
constexpr std::size_t kBlockLines = 8, kBlockSamples = 64;

template <typename T>
void transposeBlocks(std::span<const T> in, std::size_t lines, std::size_t samples,
                     std::uint32_t* out) {
  CHECK_EQ(in.size(), lines * samples);
  for (std::size_t sample0 = 0; sample0 < samples; sample0 += kBlockSamples) {
    const std::size_t sample1 = std::min(sample0 + kBlockSamples, samples);
    for (std::size_t line0 = 0; line0 < lines; line0 += kBlockLines) {
      const std::size_t line_count = std::min(kBlockLines, lines - line0);
      const T* from = in.data() + line0 * samples;
      for (std::size_t sample = sample0; sample < sample1; ++sample) {
        std::uint32_t* row = out + sample * lines + line0;
        for (std::size_t line = 0; line < line_count; ++line)
          row[line] = std::bit_cast<std::uint32_t>(from[line * samples + sample]);
      }
    }
  }
}

}  // namespace

std::optional<std::size_t> firstUnusable(std::span<const float> values) {
  // No early exit: planes are nearly always sound, and a loop without a branch is several times
  // faster.
  int all_usable = 1;
  for (const float value : values) all_usable &= isUsable(value);
  if (all_usable == 1) return std::nullopt;
  const auto first = std::find_if_not(values.begin(), values.end(), isUsable);
  return static_cast<std::size_t>(first - values.begin());
}

void rowsFromLines(std::span<const float> in, std::size_t lines, std::size_t samples,
                   std::uint32_t* out) {
  transposeBlocks(in, lines, samples, out);
}

void rowsFromLines(std::span<const std::uint32_t> in, std::size_t lines, std::size_t samples,
                   std::uint32_t* out) {
  transposeBlocks(in, lines, samples, out);
}

}  // namespace echocine
