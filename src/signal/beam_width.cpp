#include "signal/beam_width.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "core/lanes.h"
#include "core/parallel.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// Samples that go through all lines together. A line's share is a few cache lines in one page, and
// the sums of a usual window's lines stay in the first-level cache.
constexpr int kBlock = 256;
// From row to row: rows a power of two apart would share cache sets.
constexpr std::size_t kRow = kBlock + 16;
// Vectors that go through a loop together: their sums do not wait for each other.
constexpr int kTogether = 4;

// A box `width` samples wide around a sample's centre: whole samples inside it weigh 1, its ends
// their part.
std::vector<float> boxTaps(double width) {
  if (width <= 1) return {};
  const int reach = static_cast<int>(std::ceil((width - 1) / 2));
  std::vector<float> taps(static_cast<std::size_t>(2 * reach + 1), 1.0f);
  taps.front() = taps.back() = static_cast<float>((width - 1) / 2 - (reach - 1));
  return taps;
}

}  // namespace

BeamAverage::BeamAverage(const Probe& probe, const SignalSettings& settings, double most_half_lines)
    : lines_(probe.lines), samples_(probe.samples) {
  const ScanGeometry geometry(probe);
  const double wavelength_m = geometry.wavelength();
  taps_ = boxTaps(settings.pulse_cycles * wavelength_m / 2 / probe.sampleSpacing());
  const int reach = static_cast<int>(taps_.size()) / 2;
  for (int k = 0; k < samples_ && !taps_.empty(); ++k) {
    float sum = 0;
    for (int j = -reach; j <= reach; ++j)
      if (k + j >= 0 && k + j < samples_) sum += taps_[static_cast<std::size_t>(j + reach)];
    tap_sum_inverse_.push_back(1 / sum);
  }
  tap_sum_inverse_.resize(tap_sum_inverse_.size() + kBlock, 1.0f);  // read by whole lanes
  if (settings.beam_width == BeamWidth::none || lines_ < 2) return;
  std::vector<double> half_width_lines;
  for (int k = 0; k < samples_; ++k) {
    const double depth_m = geometry.sampleDepth(k);
    const double width_m =
        settings.beam_width == BeamWidth::fixed
            ? settings.beam_width_m
            : focusedBeamWidth(depth_m, probe.aperture_m, probe.focus_m, wavelength_m);
    const double half = width_m / lineSpacing(probe, depth_m) / 2;
    // Half a line is the line itself; a window of twice the image is all of it everywhere.
    half_width_lines.push_back(
        std::clamp(half, 0.5, most_half_lines > 0 ? most_half_lines : 2.0 * lines_));
  }
  prepareLateral(half_width_lines);
}

void BeamAverage::prepareLateral(const std::vector<double>& half_width_lines) {
  half_ = half_width_lines;
  for (int k = 0; k < samples_; ++k) {
    const double half = half_[static_cast<std::size_t>(k)];
    const double below = std::floor(0.5 - half), above = std::floor(0.5 + half);
    part_below_.push_back(static_cast<float>(1 - (0.5 - half - below)));
    part_above_.push_back(static_cast<float>(0.5 + half - above));
    scale_.push_back(static_cast<float>(1 / (2 * half)));
    const Run run{k, k + 1, static_cast<int>(below), static_cast<int>(above)};
    if (k % kBlock != 0 && runs_.back().below == run.below && runs_.back().above == run.above)
      runs_.back().last = run.last;
    else
      runs_.push_back(run);
  }
  for (std::vector<float>* read_by_lanes : {&part_below_, &part_above_, &scale_})
    read_by_lanes->resize(read_by_lanes->size() + kFloatLanes);
}

struct BeamAverage::Workspace {
  std::vector<float> padded;  // a line's part of the block with what the pulse reaches beside it
  // Sums of 2^level lines from a line on, averaged along the line, for the lines that windows
  // reach: line i is in row i modulo rows, a power of two. No sum is a difference, so a bright echo
  // leaves no rounding error in the blood beside it.
  std::vector<float> sums;
  std::size_t rows = 0;
  int levels = 0;
  std::vector<float> no_line = std::vector<float>(kBlock + kFloatLanes, 0.0f);

  // For windows of up to `whole` whole lines that reach over `lines`.
  void reserve(int lines, int whole) {
    rows = std::bit_ceil(static_cast<std::size_t>(lines));
    levels = std::max(static_cast<int>(std::bit_width(static_cast<unsigned>(whole))), 1);
    sums.resize(static_cast<std::size_t>(levels) * rows * kRow + kFloatLanes);
  }
  float* row(int level, int line) {
    const std::size_t of_level = static_cast<std::size_t>(line) & (rows - 1);
    return sums.data() + (static_cast<std::size_t>(level) * rows + of_level) * kRow;
  }
  // When line i has come to level 0.
  void addUp(int i) {
    for (int level = 1, half = 1; level < levels && i + 1 >= 2 * half; ++level, half *= 2) {
      const float* first = row(level - 1, i + 1 - 2 * half);
      const float* second = row(level - 1, i + 1 - half);
      float* both = row(level, i + 1 - 2 * half);
      for (int s = 0; s < kBlock; s += kFloatLanes)
        store(lanesAt(first + s) + lanesAt(second + s), both + s);
    }
  }
};

// Samples within the pulse of the borders between blocks, before any block was averaged
// in place: for each border and line `reach` samples before it and `reach` behind it, 0 beyond the
// line's end.
struct BeamAverage::Borders {
  std::vector<float> samples;
  std::size_t lines = 0, reach = 0;

  const float* at(int border_sample, int line) const {
    const auto border = static_cast<std::size_t>(border_sample / kBlock - 1);
    return samples.data() + (border * lines + static_cast<std::size_t>(line)) * 2 * reach;
  }
};

BeamAverage::Borders BeamAverage::bordersOf(const std::vector<float>& plane) const {
  const int reach = static_cast<int>(taps_.size()) / 2;
  Borders borders{{}, static_cast<std::size_t>(lines_), static_cast<std::size_t>(reach)};
  const int count = reach > 0 ? (samples_ - 1) / kBlock : 0;
  borders.samples.resize(static_cast<std::size_t>(count) * borders.lines * 2 * borders.reach);
  float* to = borders.samples.data();
  for (int at = kBlock; at <= count * kBlock; at += kBlock)
    for (int line = 0; line < lines_; ++line, to += 2 * reach) {
      const float* of_line = plane.data() + std::ptrdiff_t{line} * samples_;
      const int from = std::max(at - reach, 0), end = std::min(at + reach, samples_);
      std::copy(of_line + from, of_line + end, to + (from - (at - reach)));
    }
  return borders;
}

// The block's samples of a line, averaged over the pulse. Beyond the line's ends there is nothing.
void BeamAverage::averageAlong(const float* plane, int line, int first, int count,
                               const Borders& borders, Workspace& w) const {
  const float* own = plane + std::ptrdiff_t{line} * samples_ + first;
  float* out = w.row(0, line);
  if (taps_.empty()) {
    std::copy_n(own, count, out);
    return;
  }
  const float* scale = tap_sum_inverse_.data() + first;  // filled up to whole blocks
  const int reach = static_cast<int>(borders.reach), width = kTogether * int{kFloatLanes};
  const std::size_t last = taps_.size() - 1;
  const float end_tap = taps_.front();  // of both ends; those between weigh 1
  for (int s = 0; s < count; s += width) {
    const float* in = own + s - reach;
    if (s < reach || s + width + reach > count) {  // what this block does not hold
      w.padded.assign(static_cast<std::size_t>(width + 2 * reach), 0.0f);
      float* const padded = w.padded.data() - (s - reach);
      if (s < reach && first > 0)
        std::copy_n(borders.at(first, line) + s, reach - s, padded + s - reach);
      std::copy(own + std::max(s - reach, 0), own + std::min(s + width + reach, count),
                padded + std::max(s - reach, 0));
      if (s + width + reach > count && first + count < samples_)
        std::copy_n(borders.at(first + count, line) + reach, s + width + reach - count,
                    padded + count);
      in = w.padded.data();
    }
    Floats8 sum[kTogether];
    for (int v = 0; v < kTogether; ++v)
      sum[v] = end_tap * (lanesAt(in + v * kFloatLanes) + lanesAt(in + v * kFloatLanes + last));
    for (std::size_t j = 1; j < last; ++j)
      for (int v = 0; v < kTogether; ++v) sum[v] += lanesAt(in + v * kFloatLanes + j);
    for (int v = 0; v < kTogether; ++v)
      store(sum[v] * lanesAt(scale + s + v * kFloatLanes), out + s + v * kFloatLanes);
  }
}

namespace {

// The lines that a window sums: whole lines, as sums of powers of two of them, and parts of the two
// lines at its ends.
struct Window {
  const float *below, *part_below, *above, *part_above, *scale;
  std::array<const float*, std::numeric_limits<int>::digits> whole;
  int count = 0;  // of these

  template <int kVectors>
  void mean(int s, Floats8 (&sum)[kVectors]) const {
    for (int v = 0; v < kVectors; ++v) {
      const int at = s + v * static_cast<int>(kFloatLanes);
      sum[v] = lanesAt(part_below + at) * lanesAt(below + at) +
               lanesAt(part_above + at) * lanesAt(above + at);
    }
    for (int j = 0; j < count; ++j)
      for (int v = 0; v < kVectors; ++v) sum[v] += lanesAt(whole[j] + s + v * kFloatLanes);
    for (int v = 0; v < kVectors; ++v) sum[v] *= lanesAt(scale + s + v * kFloatLanes);
  }

  void means(int samples, float* out) const {
    int s = 0;
    for (Floats8 sum[kTogether]; s + kTogether * int{kFloatLanes} <= samples;
         s += kTogether * kFloatLanes) {
      mean(s, sum);
      for (int v = 0; v < kTogether; ++v) store(sum[v], out + s + v * kFloatLanes);
    }
    for (Floats8 sum[1]; s < samples; s += kFloatLanes) {
      mean(s, sum);
      storeSome(sum[0], static_cast<std::size_t>(samples - s), out + s);
    }
  }
};

}  // namespace

// Means over the lines between i + 1/2 - h and i + 1/2 + h, cut at the first and last line.
void BeamAverage::averageAcross(int i, const Run& run, int block_first, Workspace& w,
                                float* out) const {
  const bool cut_below = i + run.below < 0, cut_above = i + run.above >= lines_;
  const int lane = run.first - block_first, count = run.last - run.first;
  Window window{(cut_below ? w.no_line.data() : w.row(0, i + run.below)) + lane,
                part_below_.data() + run.first,
                (cut_above ? w.no_line.data() : w.row(0, i + run.above)) + lane,
                part_above_.data() + run.first,
                scale_.data() + run.first,
                {}};
  int line = std::max(i + run.below + 1, 0);
  for (int left = std::min(i + run.above, lines_) - line; left > 0;) {
    const int level = std::bit_width(static_cast<unsigned>(left)) - 1;
    window.whole[static_cast<std::size_t>(window.count++)] = w.row(level, line) + lane;
    line += 1 << level;
    left -= 1 << level;
  }
  float cut_scale[kBlock + kFloatLanes];
  if (cut_below || cut_above) {
    const double* half = half_.data() + run.first;
    for (int s = 0; s < count; ++s)
      cut_scale[s] = static_cast<float>(
          1 / ((cut_above ? lines_ : i + 0.5 + half[s]) - (cut_below ? 0 : i + 0.5 - half[s])));
    window.scale = cut_scale;
  }
  window.means(count, out);
}

void BeamAverage::averageBlock(float* plane, LineRange lines, int first, int count,
                               const Borders& borders, Workspace& w) const {
  const auto place = [&](int line, int sample) {
    return plane + std::ptrdiff_t{line} * samples_ + sample;
  };
  if (runs_.empty()) {
    w.reserve(1, 1);
    for (int i = lines.first; i < lines.end; ++i) {
      averageAlong(plane, i, first, count, borders, w);
      std::copy_n(w.row(0, i), count, place(i, first));
    }
    return;
  }
  const auto reaches = [&](int k, const Run& run) { return k < run.first; };
  const auto begin = std::upper_bound(runs_.begin(), runs_.end(), first, reaches) - 1;
  const auto end = std::upper_bound(runs_.begin(), runs_.end(), first + count - 1, reaches);
  int below = 0, above = 0, whole = 0;
  for (auto run = begin; run != end; ++run) {
    below = std::min(below, run->below);
    above = std::max(above, run->above);
    whole = std::max(whole, std::min(run->above - run->below - 1, lines_));
  }
  w.reserve(std::min(above - below, lines_) + 2, whole);
  // Line i is averaged along when it comes, and across once the lines its windows reach are there:
  // no other then needs it as it was.
  for (int i = std::max(lines.first + below, 0); i < lines.end + above; ++i) {
    if (i < lines_) {
      // Lines are pages apart, which no processor foresees.
      const float* soon = place(std::min(i + 2, lines_ - 1), first);
      for (int s = 0; s < count; s += 16) __builtin_prefetch(soon + s);
      averageAlong(plane, i, first, count, borders, w);
      w.addUp(i);
    }
    const int done = i - above;
    if (done < lines.first) continue;
    for (auto run = begin; run != end; ++run)
      averageAcross(done, *run, first, w, place(done, run->first));
  }
}

void BeamAverage::apply(std::vector<float>& plane, LineRange lines) const {
  if (taps_.empty() && runs_.empty()) return;
  const Borders borders = bordersOf(plane);
  parallelBlocks(static_cast<std::size_t>(samples_), kBlock,
                 [&](std::size_t begin, std::size_t end) {
                   thread_local Workspace workspace;
                   averageBlock(plane.data(), lines, static_cast<int>(begin),
                                static_cast<int>(end - begin), borders, workspace);
                 });
}

}  // namespace echocine
