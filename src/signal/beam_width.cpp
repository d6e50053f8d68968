#include "signal/beam_width.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/lanes.h"
#include "core/parallel.h"

namespace echocine {

namespace {

// Samples that go through all lines together. A line's share is a few cache lines in one page, and
// the sums of a usual window's lines stay in the first-level cache.
constexpr int kBlock = 256;
// Taken in double, since both may hold a bright echo.
Floats8 differenceAt(const double* a, const double* b) {
  using Sums = double __attribute__((vector_size(kFloatLanes * sizeof(double))));
  Sums of_a, of_b;
  std::memcpy(&of_a, a, sizeof of_a);
  std::memcpy(&of_b, b, sizeof of_b);
  return __builtin_convertvector(of_a - of_b, Floats8);
}

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

BeamAverage::BeamAverage(const Probe& probe, const SignalSettings& settings)
    : lines_(probe.lines), samples_(probe.samples) {
  const double wavelength_m = kScannerSpeed / probe.frequency_hz;
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
    const double depth_m = probe.min_depth_m + (k + 0.5) * probe.sampleSpacing();
    const double width_m =
        settings.beam_width == BeamWidth::fixed
            ? settings.beam_width_m
            : focusedBeamWidth(depth_m, probe.aperture_m, probe.focus_m, wavelength_m);
    const double half = width_m / lineSpacing(probe, depth_m) / 2;
    // Half a line is the line itself; a window of twice the image is all of it everywhere.
    half_width_lines.push_back(std::clamp(half, 0.5, 2.0 * lines_));
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
  // The block's averages along the lines that windows reach, and the sums over all lines before
  // each of them: line i stands in row i modulo rows, a power of two. Sums in double: a bright echo
  // leaves nothing behind in the blood beside it.
  std::vector<float> along;
  std::vector<double> sums;
  std::size_t rows = 0;
  std::vector<float> no_line = std::vector<float>(kBlock + kFloatLanes, 0.0f);
  std::vector<double> no_sum = std::vector<double>(kBlock + kFloatLanes, 0.0);

  void reserve(int lines) {
    rows = std::bit_ceil(static_cast<std::size_t>(lines));
    along.resize(rows * kBlock + kFloatLanes);
    sums.resize(rows * kBlock + kFloatLanes);
  }
  std::size_t row(int line) const { return (static_cast<std::size_t>(line) & (rows - 1)) * kBlock; }
};

// The block's samples of a line, averaged over the pulse. Beyond the line's ends there is nothing.
void BeamAverage::averageAlong(const float* line, int first, int count, Workspace& w,
                               float* out) const {
  const int reach = static_cast<int>(taps_.size()) / 2;
  const int begin = first - reach, end = first + kBlock + reach;
  const float* in = line + begin;
  if (begin < 0 || end > samples_) {
    w.padded.assign(static_cast<std::size_t>(end - begin), 0.0f);
    const int from = std::max(begin, 0), to = std::min(end, samples_);
    std::copy(line + from, line + to, w.padded.begin() + (from - begin));
    in = w.padded.data();
  }
  if (taps_.empty()) {
    std::copy_n(in, kBlock, out);
    return;
  }
  const float* scale = tap_sum_inverse_.data() + first;  // filled up to whole blocks
  const std::size_t last = taps_.size() - 1;
  const float end_tap = taps_.front();  // of both ends; those between weigh 1
  constexpr int kTogether = 4;
  for (int s = 0; s < count; s += kTogether * kFloatLanes) {
    Floats8 sum[kTogether];
    for (int v = 0; v < kTogether; ++v)
      sum[v] =
          end_tap * (lanesAt(in + s + v * kFloatLanes) + lanesAt(in + s + v * kFloatLanes + last));
    for (std::size_t j = 1; j < last; ++j)
      for (int v = 0; v < kTogether; ++v) sum[v] += lanesAt(in + s + v * kFloatLanes + j);
    for (int v = 0; v < kTogether; ++v)
      store(sum[v] * lanesAt(scale + s + v * kFloatLanes), out + s + v * kFloatLanes);
  }
}

// Means over the lines between i + 1/2 - h and i + 1/2 + h, cut at the first and last line: the
// whole lines between the two at the ends, from the running sums, and of these two their parts.
void BeamAverage::averageAcross(int i, const Run& run, int block_first, const Workspace& w,
                                float* out) const {
  const bool cut_below = i + run.below < 0, cut_above = i + run.above >= lines_;
  const int lane = run.first - block_first, count = run.last - run.first;
  const double* before = (cut_below ? w.no_sum.data() : &w.sums[w.row(i + run.below + 1)]) + lane;
  const double* after = &w.sums[w.row(cut_above ? lines_ : i + run.above)] + lane;
  const float* below = (cut_below ? w.no_line.data() : &w.along[w.row(i + run.below)]) + lane;
  const float* above = (cut_above ? w.no_line.data() : &w.along[w.row(i + run.above)]) + lane;
  const float* scale = scale_.data() + run.first;
  float cut_scale[kBlock + kFloatLanes];
  if (cut_below || cut_above) {
    const double* half = half_.data() + run.first;
    for (int s = 0; s < count; ++s)
      cut_scale[s] = static_cast<float>(
          1 / ((cut_above ? lines_ : i + 0.5 + half[s]) - (cut_below ? 0 : i + 0.5 - half[s])));
    scale = cut_scale;
  }
  const float* part_below = part_below_.data() + run.first;
  const float* part_above = part_above_.data() + run.first;
  for (int s = 0; s < count; s += kFloatLanes) {
    const Floats8 sum = differenceAt(after + s, before + s) +
                        lanesAt(part_below + s) * lanesAt(below + s) +
                        lanesAt(part_above + s) * lanesAt(above + s);
    storeSome(sum * lanesAt(scale + s), static_cast<std::size_t>(count - s), out + s);
  }
}

void BeamAverage::averageBlock(const float* in, float* out, int first, int count,
                               Workspace& w) const {
  if (runs_.empty()) {
    w.reserve(1);
    for (int i = 0; i < lines_; ++i, in += samples_, out += samples_) {
      averageAlong(in, first, count, w, w.along.data());
      std::copy_n(w.along.begin(), count, out + first);
    }
    return;
  }
  const auto reaches = [&](int k, const Run& run) { return k < run.first; };
  const auto begin = std::upper_bound(runs_.begin(), runs_.end(), first, reaches) - 1;
  const auto end = std::upper_bound(runs_.begin(), runs_.end(), first + count - 1, reaches);
  int below = 0, above = 0;
  for (auto run = begin; run != end; ++run) {
    below = std::min(below, run->below);
    above = std::max(above, run->above);
  }
  w.reserve(std::min(above - below, lines_) + 2);
  std::fill_n(w.sums.begin(), kBlock, 0.0);
  // Line i is averaged along when it comes, and across once the lines its windows reach are there.
  for (int i = 0; i < lines_ + above; ++i) {
    if (i < lines_) {
      float* along = &w.along[w.row(i)];
      // Lines are pages apart, which no processor foresees.
      const float* soon = in + std::ptrdiff_t{std::min(i + 2, lines_ - 1)} * samples_ + first;
      for (int s = 0; s < count; s += 16) __builtin_prefetch(soon + s);
      averageAlong(in + std::ptrdiff_t{i} * samples_, first, count, w, along);
      const double* before = &w.sums[w.row(i)];
      double* after = &w.sums[w.row(i + 1)];
      for (int s = 0; s < kBlock; ++s) after[s] = before[s] + static_cast<double>(along[s]);
    }
    const int done = i - above;
    if (done < 0) continue;
    for (auto run = begin; run != end; ++run)
      averageAcross(done, *run, first, w, out + std::ptrdiff_t{done} * samples_ + run->first);
  }
}

void BeamAverage::apply(std::vector<float>& plane, std::vector<float>& scratch) const {
  if (taps_.empty() && runs_.empty()) return;
  scratch.resize(plane.size());
  parallelBlocks(static_cast<std::size_t>(samples_), kBlock,
                 [&](std::size_t begin, std::size_t end) {
                   thread_local Workspace workspace;
                   averageBlock(plane.data(), scratch.data(), static_cast<int>(begin),
                                static_cast<int>(end - begin), workspace);
                 });
  plane.swap(scratch);
}

}  // namespace echocine
