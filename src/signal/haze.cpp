#include "signal/haze.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "core/units.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

constexpr int kSideBySide = 32;  // samples, or lines, that go through a recursion side by side

}  // namespace

LateralHaze::LateralHaze(const Probe& probe, double level_db, double width_rad)
    : lines_(probe.lines), samples_(probe.samples), full_turn_(probe.isFullTurn()) {
  const double a = std::exp(-1 / ScanGeometry(probe).linesAcross(width_rad));
  decay_ = static_cast<float>(a);
  level_ = static_cast<float>(intensityFromDecibels(level_db) * (1 - a) / (1 + a));
}

void LateralHaze::add(std::span<float> plane) const {
  const auto blocks = static_cast<std::size_t>((samples_ + kSideBySide - 1) / kSideBySide);
  parallelBlocks(blocks, 8, [&](std::size_t begin, std::size_t end) {
    thread_local std::vector<std::array<float, kSideBySide>> before;
    before.resize(static_cast<std::size_t>(lines_));
    for (std::size_t b = begin; b < end; ++b) {
      const int first = static_cast<int>(b) * kSideBySide,
                count = std::min(kSideBySide, samples_ - first);
      const auto row = [&](int line) {
        return plane.data() + static_cast<std::ptrdiff_t>(line) * samples_ + first;
      };
      // The sums at the seam, where a turn's recursions start: those of all lines over 1 - a^N.
      std::array<float, kSideBySide> sum{}, seam{};
      if (full_turn_) {
        const float per_turn = 1 / (1 - std::pow(decay_, static_cast<float>(lines_)));
        for (int i = 0; i < lines_; ++i)
          for (int k = 0; k < count; ++k) sum[k] = row(i)[k] + decay_ * sum[k];
        for (int i = lines_ - 1; i >= 0; --i)
          for (int k = 0; k < count; ++k) seam[k] = decay_ * (row(i)[k] + seam[k]);
        for (int k = 0; k < count; ++k) {
          sum[k] *= per_turn;
          seam[k] *= per_turn;
        }
      }
      for (int i = 0; i < lines_; ++i) {
        for (int k = 0; k < count; ++k) sum[k] = row(i)[k] + decay_ * sum[k];
        before[static_cast<std::size_t>(i)] = sum;
      }
      sum = seam;
      for (int i = lines_ - 1; i >= 0; --i)
        for (int k = 0; k < count; ++k) {
          const float own = row(i)[k];
          row(i)[k] += level_ * (before[static_cast<std::size_t>(i)][k] + sum[k]);
          sum[k] = decay_ * (own + sum[k]);
        }
    }
  });
}

ReverberationTail::ReverberationTail(const Probe& probe, double level_db, double length_m)
    : samples_(probe.samples) {
  const double a = std::exp(-probe.sampleSpacing() / length_m);
  decay_ = static_cast<float>(a);
  level_ = static_cast<float>(intensityFromDecibels(level_db) * (1 - a));
}

// Lines side by side: each sum waits for its own last one alone.
void ReverberationTail::add(std::span<float> plane) const {
  constexpr int kLines = 8;
  const int lines = static_cast<int>(plane.size() / static_cast<std::size_t>(samples_));
  const auto blocks = static_cast<std::size_t>((lines + kLines - 1) / kLines);
  parallelBlocks(blocks, 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const int first = static_cast<int>(b) * kLines, count = std::min(kLines, lines - first);
      float* at = plane.data() + static_cast<std::ptrdiff_t>(first) * samples_;
      std::array<float, kLines> tail{};
      for (int k = 0; k < samples_; ++k)
        for (int j = 0; j < count; ++j) {
          float& value = at[static_cast<std::ptrdiff_t>(j) * samples_ + k];
          const float own = value;
          value += level_ * tail[static_cast<std::size_t>(j)];
          tail[static_cast<std::size_t>(j)] = own + decay_ * tail[static_cast<std::size_t>(j)];
        }
    }
  });
}

}  // namespace echocine
