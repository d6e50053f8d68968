#include "signal/beam_width.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace echocine {

namespace {

constexpr int kTile = 16;  // samples whose running sums share a pass over the lines

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

double focusedBeamWidth(double depth_m, double aperture_m, double focus_m, double wavelength_m) {
  constexpr double kSixDecibelWidth =
      1.2067;  // 2 x for sinc^2(x) = 1/4, sinc(x) = sin(pi x)/(pi x)
  const double receive = kSixDecibelWidth * wavelength_m * depth_m / aperture_m;
  const double transmit = std::hypot(receive, aperture_m * (1 - depth_m / focus_m));
  return transmit > 0 ? receive * transmit / std::hypot(receive, transmit) : 0;
}

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
  if (settings.beam_width == BeamWidth::none || lines_ < 2) return;
  for (int k = 0; k < samples_; ++k) {
    const double depth_m = probe.min_depth_m + (k + 0.5) * probe.sampleSpacing();
    const double width_m =
        settings.beam_width == BeamWidth::fixed
            ? settings.beam_width_m
            : focusedBeamWidth(depth_m, probe.aperture_m, probe.focus_m, wavelength_m);
    const double half = width_m / lineSpacing(probe, depth_m) / 2;
    // Half a line is the line itself; a window of twice the image is all of it everywhere.
    half_width_lines_.push_back(std::clamp(half, 0.5, 2.0 * lines_));
  }
}

void BeamAverage::averageAxially(std::span<float> line, std::vector<float>& padded) const {
  const std::size_t reach = taps_.size() / 2;
  padded.assign(line.size() + 2 * reach, 0.0f);
  std::copy(line.begin(), line.end(), padded.begin() + static_cast<std::ptrdiff_t>(reach));
  std::fill(line.begin(), line.end(), 0.0f);
  for (std::size_t j = 0; j < taps_.size(); ++j) {
    const float* in = padded.data() + j;
    const float tap = taps_[j];
    for (std::size_t k = 0; k < line.size(); ++k) line[k] += tap * in[k];
  }
  for (std::size_t k = 0; k < line.size(); ++k) line[k] *= tap_sum_inverse_[k];
}

namespace {

// Mean of a column of values over the lines between i + 1/2 - h and i + 1/2 + h, from its running
// sums (sums[i] over the lines before i, one entry more at the end). Windows are cut at the first
// and last line.
void windowMeans(const std::vector<double>& sums, std::size_t lines, double h, float* means) {
  const double end = static_cast<double>(lines);
  const auto cut = [&](std::size_t i) {
    const double x0 = std::max(static_cast<double>(i) + 0.5 - h, 0.0);
    const double x1 = std::min(static_cast<double>(i) + 0.5 + h, end);
    const auto i0 = static_cast<std::size_t>(x0), i1 = static_cast<std::size_t>(x1);
    const double s0 = sums[i0] + (x0 - std::floor(x0)) * (sums[i0 + 1] - sums[i0]);
    const double s1 = sums[i1] + (x1 - std::floor(x1)) * (sums[i1 + 1] - sums[i1]);
    means[i] = static_cast<float>(std::max(s1 - s0, 0.0) / (x1 - x0));
  };
  // Whole windows lie at the same place relative to their line: no division and no index to
  // compute.
  const auto first = static_cast<std::size_t>(std::min(std::ceil(h - 0.5), end));
  const std::size_t last = std::max(lines - first, first);
  for (std::size_t i = 0; i < std::min(first, lines); ++i) cut(i);
  const double below = std::floor(0.5 - h), above = std::floor(0.5 + h);
  const double f0 = 0.5 - h - below, f1 = 0.5 + h - above, scale = 1 / (2 * h);
  const std::size_t whole = std::min(last, lines) - std::min(first, lines);
  const double from = static_cast<double>(std::min(first, lines));
  const double* low = sums.data() + static_cast<std::ptrdiff_t>(whole > 0 ? from + below : 0);
  const double* high = sums.data() + static_cast<std::ptrdiff_t>(whole > 0 ? from + above : 0);
  for (std::size_t j = 0; j < whole; ++j) {
    const double s0 = low[j] + f0 * (low[j + 1] - low[j]);
    const double s1 = high[j] + f1 * (high[j + 1] - high[j]);
    means[first + j] = static_cast<float>(std::max(s1 - s0, 0.0) * scale);
  }
  for (std::size_t i = std::max(last, std::min(first, lines)); i < lines; ++i) cut(i);
}

}  // namespace

// Running sums over the lines for a few samples at once. Sums are double: a bright echo leaves
// nothing behind in the blood beside it.
void BeamAverage::averageLaterally(std::span<const float> in, std::span<float> out,
                                   int first_sample) const {
  const auto count = static_cast<std::size_t>(std::min(kTile, samples_ - first_sample));
  const auto stride = static_cast<std::size_t>(samples_);
  const auto lines = static_cast<std::size_t>(lines_);
  const auto first = static_cast<std::size_t>(first_sample);
  thread_local std::vector<double> sums, column;
  thread_local std::vector<float> means;
  sums.resize((lines + 1) * kTile);
  column.resize(lines + 2);
  means.resize(lines * kTile);
  std::fill_n(sums.begin(), kTile, 0.0);
  for (std::size_t i = 0; i < lines; ++i) {
    const float* values = in.data() + i * stride + first;
    const double* before = sums.data() + i * kTile;
    double* after = sums.data() + (i + 1) * kTile;
    for (std::size_t s = 0; s < count; ++s) after[s] = before[s] + static_cast<double>(values[s]);
  }
  for (std::size_t s = 0; s < count; ++s) {
    for (std::size_t i = 0; i <= lines; ++i) column[i] = sums[i * kTile + s];
    column[lines + 1] = column[lines];
    windowMeans(column, lines, half_width_lines_[first + s], means.data() + s * lines);
  }
  for (std::size_t i = 0; i < lines; ++i)
    for (std::size_t s = 0; s < count; ++s) out[i * stride + first + s] = means[s * lines + i];
}

void BeamAverage::apply(std::span<float> plane, std::vector<float>& scratch) const {
  const auto samples = static_cast<std::size_t>(samples_);
  if (!taps_.empty())
    parallelBlocks(static_cast<std::size_t>(lines_), 16, [&](std::size_t begin, std::size_t end) {
      thread_local std::vector<float> padded;
      for (std::size_t i = begin; i < end; ++i)
        averageAxially(plane.subspan(i * samples, samples), padded);
    });
  if (half_width_lines_.empty()) return;
  scratch.assign(plane.begin(), plane.end());
  parallelBlocks(samples, kTile, [&](std::size_t begin, std::size_t) {
    averageLaterally(scratch, plane, static_cast<int>(begin));
  });
}

}  // namespace echocine
