#include "metrics/frame_metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "metrics/structural_similarity.h"

namespace echocine {

namespace {

// Weighted sums for a correlation coefficient, about offsets near the means so that nothing
// cancels.
struct Correlation {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  void add(double w, double a, double b) {
    n += w, x += w * a, y += w * b, xx += w * a * a, yy += w * b * b, xy += w * a * b;
  }
  double coefficient() const {
    if (!(n > 0)) return 0;
    const double vx = xx - x * x / n, vy = yy - y * y / n;
    const double least = 1e-9 * n;  // of a grey level squared: rounding, not signal
    if (vx <= least || vy <= least) return vx <= least && vy <= least ? 1 : 0;
    return std::clamp((xy - x * y / n) / std::sqrt(vx * vy), -1.0, 1.0);
  }
};

constexpr int kBins = 32;

double mutualInformation(const BeamPair& p) {
  std::vector<double> joint(kBins * kBins, 0);
  std::array<double, kBins> of_x{}, of_y{};
  double n = 0;
  const auto bin = [](float grey) {
    return static_cast<std::size_t>(
        std::clamp(static_cast<int>(grey * (kBins / 256.0f)), 0, kBins - 1));
  };
  for (std::size_t i = 0; i < p.x.size(); ++i) {
    const double w = p.weights[i];
    if (!(w > 0)) continue;
    const std::size_t a = bin(p.x[i]), b = bin(p.y[i]);
    joint[a * kBins + b] += w;
    of_x[a] += w;
    of_y[b] += w;
    n += w;
  }
  double bits = 0;
  for (std::size_t a = 0; a < kBins; ++a)
    for (std::size_t b = 0; b < kBins; ++b)
      if (const double j = joint[a * kBins + b]; j > 0)
        bits += j / n * std::log2(j * n / (of_x[a] * of_y[b]));
  return std::max(0.0, bits);
}

// The earth mover's distance of the two histograms: the area between their sums.
double histogramDistance(const BeamPair& p) {
  std::array<double, 256> difference{};
  double n = 0;
  const auto bin = [](float grey) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(std::lround(grey)), 0, 255));
  };
  for (std::size_t i = 0; i < p.x.size(); ++i) {
    const double w = p.weights[i];
    if (!(w > 0)) continue;
    difference[bin(p.x[i])] += w;
    difference[bin(p.y[i])] -= w;
    n += w;
  }
  double sum = 0, area = 0;
  for (const double d : difference) area += std::abs(sum += d);
  return n > 0 ? area / n : 0;
}

double psnrOf(double rms) {
  return rms > 0 ? 20 * std::log10(255 / rms) : std::numeric_limits<double>::infinity();
}

}  // namespace

double gradientCorrelation(const BeamPair& p) {
  const auto lines = static_cast<std::size_t>(p.lines),
             samples = static_cast<std::size_t>(p.samples);
  const auto along = [&](std::size_t step, std::size_t first_line, std::size_t first_sample) {
    Correlation sums;
    for (std::size_t i = first_line; i + first_line < lines; ++i)
      for (std::size_t k = first_sample; k + first_sample < samples; ++k) {
        const std::size_t at = i * samples + k;
        if (!(p.weights[at] > 0 && p.weights[at - step] > 0 && p.weights[at + step] > 0)) continue;
        sums.add(p.weights[at], p.x[at + step] - p.x[at - step], p.y[at + step] - p.y[at - step]);
      }
    return sums.coefficient();
  };
  return 0.5 * (along(samples, 1, 0) + along(1, 0, 1));
}

double structuralSimilarity(const BeamPair& p) {
  return echocine::structuralSimilarity(p.x, p.y, p.weights, p.weights, p.lines, p.samples)
      .value_or(0);
}

FrameMetrics frameMetrics(const BeamPair& p) {
  FrameMetrics m;
  double squares = 0, absolutes = 0;
  Correlation sums;
  for (std::size_t i = 0; i < p.x.size(); ++i) {
    const double w = p.weights[i];
    if (!(w > 0)) continue;
    const double d = static_cast<double>(p.x[i]) - p.y[i];
    squares += w * d * d;
    absolutes += w * std::abs(d);
    sums.add(w, p.x[i], p.y[i]);
  }
  m.weight = sums.n;
  if (!(m.weight > 0)) return m;
  m.rms = std::sqrt(squares / m.weight);
  m.mean_absolute = absolutes / m.weight;
  m.psnr_db = psnrOf(m.rms);
  m.ncc = sums.coefficient();
  m.ssim = structuralSimilarity(p);
  m.mutual_information = mutualInformation(p);
  m.histogram_distance = histogramDistance(p);
  m.gradient_correlation = gradientCorrelation(p);
  return m;
}

FrameMetrics loopMetrics(std::span<const FrameMetrics> frames) {
  FrameMetrics mean;
  double n = 0;
  for (const FrameMetrics& m : frames) {
    if (!(m.weight > 0)) continue;
    ++n;
    mean.weight += m.weight;
    for (const Metric& metric : kMetrics) {
      const double value = m.*metric.value;
      if (metric.mean == LoopMean::arithmetic) mean.*metric.value += value;
      if (metric.mean == LoopMean::root_mean_square) mean.*metric.value += value * value;
    }
  }
  if (n == 0) return mean;
  mean.weight /= n;
  for (const Metric& metric : kMetrics) {
    double& value = mean.*metric.value;
    if (metric.mean == LoopMean::arithmetic) value /= n;
    if (metric.mean == LoopMean::root_mean_square) value = std::sqrt(value / n);
    if (metric.mean == LoopMean::psnr) value = psnrOf(mean.rms);
  }
  return mean;
}

}  // namespace echocine
