#include "signal/beam_width.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/parallel.h"

namespace echocine {

namespace {

// Samples that go through all lines together. A line's share is a few cache lines in one page, and
// the sums of a usual window's lines stay in the first-level cache.
constexpr int kBlock = 128;
// Eight of them in the vector extension that GCC and Clang share: left to itself GCC shuffles.
constexpr int kLanes = 8;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

Lanes lanesAt(const float* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
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
    part_below_.push_back(0.5 - half - below);
    part_above_.push_back(0.5 + half - above);
    scale_.push_back(1 / (2 * half));
    const Run run{k, k + 1, static_cast<int>(below), static_cast<int>(above)};
    if (k % kBlock != 0 && runs_.back().below == run.below && runs_.back().above == run.above)
      runs_.back().last = run.last;
    else
      runs_.push_back(run);
  }
}

struct BeamAverage::Workspace {
  std::vector<float> padded;  // a line's part of the block with what the pulse reaches beside it
  std::vector<float> along;   // the block's averages along the present line
  // Sums over the lines before each, for the lines that windows reach: line i stands in row i
  // modulo rows. Double: a bright echo leaves nothing behind in the blood beside it.
  std::vector<double> sums;
  std::vector<double> zeros;  // the sums before the first line
  std::size_t rows = 0;
  double* row(int line) { return sums.data() + static_cast<std::size_t>(line) % rows * kBlock; }
};

// The block's samples of a line, averaged over the pulse. Beyond the line's ends there is nothing.
void BeamAverage::averageAlong(const float* line, int first, int count, Workspace& w) const {
  const int reach = static_cast<int>(taps_.size()) / 2;
  const int begin = first - reach, end = first + kBlock + reach;
  const float* in = line + begin;
  if (begin < 0 || end > samples_) {
    w.padded.assign(static_cast<std::size_t>(end - begin), 0.0f);
    const int from = std::max(begin, 0), to = std::min(end, samples_);
    std::copy(line + from, line + to, w.padded.begin() + (from - begin));
    in = w.padded.data();
  }
  float* out = w.along.data();
  if (taps_.empty()) {
    std::copy_n(in, count, out);
    return;
  }
  const float* scale = tap_sum_inverse_.data() + first;  // filled up to whole blocks
  for (int s = 0; s < count; s += 2 * kLanes) {
    Lanes sum{}, next{};
    for (std::size_t j = 0; j < taps_.size(); ++j) {
      const float* from = in + s + j;
      sum += taps_[j] * lanesAt(from);
      next += taps_[j] * lanesAt(from + kLanes);
    }
    sum *= lanesAt(scale + s);
    next *= lanesAt(scale + s + kLanes);
    std::memcpy(out + s, &sum, sizeof sum);
    std::memcpy(out + s + kLanes, &next, sizeof next);
  }
}

// Means over the lines between i + 1/2 - h and i + 1/2 + h, cut at the first and last line, from
// the running sums.
void BeamAverage::averageAcross(int i, const Run& run, int block_first, Workspace& w,
                                float* out) const {
  const bool cut_below = i + run.below < 0, cut_above = i + run.above >= lines_;
  const int lane = run.first - block_first, count = run.last - run.first;
  const double* low = (cut_below ? w.zeros.data() : w.row(i + run.below)) + lane;
  const double* low_next = (cut_below ? w.zeros.data() : w.row(i + run.below + 1)) + lane;
  const double* high = w.row(cut_above ? lines_ : i + run.above) + lane;
  const double* high_next = w.row(cut_above ? lines_ : i + run.above + 1) + lane;
  const double* f0 = part_below_.data() + run.first;
  const double* f1 = part_above_.data() + run.first;
  const double* scale = scale_.data() + run.first;
  double cut_scale[kBlock];
  if (cut_below || cut_above) {
    const double* half = half_.data() + run.first;
    for (int s = 0; s < count; ++s)
      cut_scale[s] =
          1 / ((cut_above ? lines_ : i + 0.5 + half[s]) - (cut_below ? 0 : i + 0.5 - half[s]));
    scale = cut_scale;
  }
  for (int s = 0; s < count; ++s) {
    const double s0 = low[s] + f0[s] * (low_next[s] - low[s]);
    const double s1 = high[s] + f1[s] * (high_next[s] - high[s]);
    out[s] = static_cast<float>(std::max(s1 - s0, 0.0) * scale[s]);
  }
}

void BeamAverage::averageBlock(const float* in, float* out, int first, int count,
                               Workspace& w) const {
  w.along.resize(kBlock);
  if (runs_.empty()) {
    for (int i = 0; i < lines_; ++i, in += samples_, out += samples_) {
      averageAlong(in, first, count, w);
      std::copy_n(w.along.begin(), count, out + first);
    }
    return;
  }
  w.zeros.assign(kBlock, 0.0);
  const auto reaches = [&](int k, const Run& run) { return k < run.first; };
  const auto begin = std::upper_bound(runs_.begin(), runs_.end(), first, reaches) - 1;
  const auto end = std::upper_bound(runs_.begin(), runs_.end(), first + count - 1, reaches);
  int below = 0, above = 0;
  for (auto run = begin; run != end; ++run) {
    below = std::min(below, run->below);
    above = std::max(above, run->above);
  }
  w.rows = static_cast<std::size_t>(std::min(above - below, lines_) + 2);
  w.sums.resize(w.rows * kBlock);
  std::fill_n(w.sums.begin(), kBlock, 0.0);
  // Line i is averaged along when it comes, and across once the lines its windows reach are there.
  for (int i = 0; i < lines_ + above; ++i) {
    if (i < lines_) {
      averageAlong(in + std::ptrdiff_t{i} * samples_, first, count, w);
      const double* before = w.row(i);
      double* after = w.row(i + 1);
      for (int s = 0; s < count; ++s) after[s] = before[s] + static_cast<double>(w.along[s]);
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
