#include "output/polar_plane.h"

#include <algorithm>
#include <bit>

#include "core/check.h"

namespace echocine {
namespace {

// A block reads kBlockLines cache lines at a stride that is often a power of two and so falls into
// one set of the first-level cache: more than eight would evict each other.
constexpr std::size_t kBlockLines = 8, kBlockSamples = 64;

template <typename T, typename Out>
void transposeBlocks(std::span<const T> in, std::size_t lines, std::size_t samples, Out* out) {
  CHECK_EQ(in.size(), lines * samples);
  for (std::size_t sample0 = 0; sample0 < samples; sample0 += kBlockSamples) {
    const std::size_t sample1 = std::min(sample0 + kBlockSamples, samples);
    for (std::size_t line0 = 0; line0 < lines; line0 += kBlockLines) {
      const std::size_t line_count = std::min(kBlockLines, lines - line0);
      const T* from = in.data() + line0 * samples;
      for (std::size_t sample = sample0; sample < sample1; ++sample) {
        Out* row = out + sample * lines + line0;
        for (std::size_t line = 0; line < line_count; ++line)
          row[line] = std::bit_cast<Out>(from[line * samples + sample]);
      }
    }
  }
}

}  // namespace

void rowsFromLines(std::span<const float> in, std::size_t lines, std::size_t samples,
                   std::uint32_t* out) {
  transposeBlocks(in, lines, samples, out);
}

void rowsFromLines(std::span<const std::uint32_t> in, std::size_t lines, std::size_t samples,
                   std::uint32_t* out) {
  transposeBlocks(in, lines, samples, out);
}

std::vector<float> rowsFromLines(std::span<const float> in, std::size_t lines,
                                 std::size_t samples) {
  std::vector<float> rows(in.size());
  transposeBlocks(in, lines, samples, rows.data());
  return rows;
}

}  // namespace echocine
