#include "speckle/coherent_ratio.h"

#include <algorithm>
#include <cmath>

namespace echocine {

namespace {

// Where bells are cut: 4 % of the amplitude. Both sums are cut alike, so no law depends on it.
constexpr double kCutDeviations = 2.5;
constexpr std::size_t kMostTaps = 64;
constexpr std::size_t kPad = kMostTaps + kFloatLanes;  // of a row, either end
constexpr double kWidthAtHalf = 2.3548200450309493;    // full, of a bell, in deviations

std::size_t tapsOf(double deviation) {
  return std::min(static_cast<std::size_t>(std::ceil(kCutDeviations * deviation)), kMostTaps);
}

double bell(double distance, double deviation) {
  if (!(deviation > 0)) return distance == 0 ? 1 : 0;
  return std::exp(-0.5 * distance * distance / (deviation * deviation));
}

std::vector<float> bellTaps(double deviation) {
  std::vector<float> taps;
  for (std::size_t t = 0; t <= tapsOf(deviation); ++t)
    taps.push_back(static_cast<float>(bell(static_cast<double>(t), deviation)));
  return taps;
}

std::vector<float> normalisedTaps(double deviation) {
  std::vector<float> taps = bellTaps(deviation);
  float sum = 0;
  for (std::size_t t = 0; t < taps.size(); ++t) sum += (t == 0 ? 1 : 2) * taps[t];
  for (float& tap : taps) tap /= sum;
  return taps;
}

}  // namespace

CoherentRatio::CoherentRatio(const Probe& probe, const PointSpread& spread, const BeamView& view,
                             double smoothing_m)
    : lines_(probe.lines),
      samples_(probe.samples),
      stride_((static_cast<std::size_t>(probe.samples) + 2 * kFloatLanes) / kFloatLanes *
              kFloatLanes),
      axial_(bellTaps(spread.axial_m / probe.sampleSpacing())),
      smoothing_(normalisedTaps(smoothing_m / kWidthAtHalf / probe.sampleSpacing())) {
  std::vector<double> deviations;
  for (int k = 0; k < samples_; ++k)
    deviations.push_back(view.lateralLines(probe.min_depth_m + (k + 0.5) * probe.sampleSpacing()));
  const auto [least, most] = std::minmax_element(deviations.begin(), deviations.end());
  even_ = *most - *least < 1e-6 * *most;
  lateral_taps_ = std::min(tapsOf(*most), static_cast<std::size_t>(lines_ - 1));
  lateral_.resize((lateral_taps_ + 1) * stride_);
  for (std::size_t t = 0; t <= lateral_taps_; ++t)
    for (std::size_t k = 0; k < deviations.size(); ++k)
      if (t <= tapsOf(deviations[k]))
        lateral_[t * stride_ + k] = static_cast<float>(bell(static_cast<double>(t), deviations[k]));
  for (const float h : lateral_) lateral_squares_.push_back(h * h);
}

float* CoherentRatio::smeared(Rows& rows, int line) const {
  const std::size_t slots = 2 * lateral_taps_ + 1;
  return rows.lines.data() + static_cast<std::size_t>(line) % slots * 3 * stride_;
}

// One line's sums, weighted by the picture, and smeared along it.
void CoherentRatio::alongLine(const EchoSum* sums, const float* intensities, Rows& rows,
                              float* out) const {
  const std::size_t length = stride_ + 2 * kPad;
  float *real = rows.raw.data() + kPad, *imaginary = real + length, *squares = imaginary + length;
  for (int k = 0; k < samples_; ++k) {
    const float amplitude = std::sqrt(intensities[k]);
    real[k] = amplitude * sums[k].real;
    imaginary[k] = amplitude * sums[k].imaginary;
    squares[k] = intensities[k] * sums[k].squares;
  }
  for (std::size_t k = 0; k < stride_; k += kFloatLanes) {
    Floats8 r = axial_[0] * lanesAt(real + k), i = axial_[0] * lanesAt(imaginary + k),
            s = (axial_[0] * axial_[0]) * lanesAt(squares + k);
    for (std::size_t t = 1; t < axial_.size(); ++t) {
      const float h = axial_[t];
      r += h * (lanesAt(real + k - t) + lanesAt(real + k + t));
      i += h * (lanesAt(imaginary + k - t) + lanesAt(imaginary + k + t));
      s += (h * h) * (lanesAt(squares + k - t) + lanesAt(squares + k + t));
    }
    store(r, out + k);
    store(i, out + stride_ + k);
    store(s, out + 2 * stride_ + k);
  }
}

// |g|^2 / w of one line, 1 where no scatterer is in reach.
void CoherentRatio::acrossLines(int line, Rows& rows) const {
  constexpr float kNothing = 1e-35f;
  float* ratio = rows.ratio.data() + kPad;
  const float* middle = smeared(rows, line);
  const float* from[2 * kMostTaps];
  std::size_t taps = 0, distance[2 * kMostTaps];
  for (std::size_t t = 1; t <= lateral_taps_; ++t)
    for (const int sign : {-1, 1}) {
      const int other = line + sign * static_cast<int>(t);
      if (other < 0 || other >= lines_) continue;
      distance[taps] = t;
      from[taps++] = smeared(rows, other);
    }
  for (std::size_t k = 0; k < stride_; k += kFloatLanes) {
    Floats8 r = lanesAt(&lateral_[k]) * lanesAt(middle + k),
            i = lanesAt(&lateral_[k]) * lanesAt(middle + stride_ + k),
            s = lanesAt(&lateral_squares_[k]) * lanesAt(middle + 2 * stride_ + k);
    for (std::size_t n = 0; n < taps; ++n) {
      const std::size_t at = distance[n] * stride_ + k;
      const Floats8 h = lanesAt(&lateral_[at]);
      r += h * lanesAt(from[n] + k);
      i += h * lanesAt(from[n] + stride_ + k);
      s += lanesAt(&lateral_squares_[at]) * lanesAt(from[n] + 2 * stride_ + k);
    }
    const Floats8 quotient = (r * r + i * i) / (s > kNothing ? s : Floats8{} + 1);
    store(s > kNothing ? quotient : Floats8{} + 1, ratio + k);
  }
}

void CoherentRatio::finish(Rows& rows, float* intensities) const {
  float* ratio = rows.ratio.data() + kPad;
  for (std::size_t t = 1; t < smoothing_.size(); ++t) {  // ends are mirrored: the mean stays
    ratio[-static_cast<std::ptrdiff_t>(t)] =
        ratio[std::min<int>(static_cast<int>(t), samples_) - 1];
    ratio[samples_ + static_cast<int>(t) - 1] = ratio[std::max(samples_ - static_cast<int>(t), 0)];
  }
  for (int k = 0; k < samples_; k += kFloatLanes) {
    Floats8 sum = smoothing_[0] * lanesAt(ratio + k);
    for (std::size_t t = 1; t < smoothing_.size(); ++t)
      sum += smoothing_[t] * (lanesAt(ratio + k - t) + lanesAt(ratio + k + t));
    const auto left = static_cast<std::size_t>(samples_ - k);
    Floats8 i{};
    std::memcpy(&i, intensities + k, std::min(left, kFloatLanes) * sizeof(float));
    storeSome(i * sum, left, intensities + k);
  }
}

void CoherentRatio::apply(EchoSums& sums, Rows& rows, std::span<float> intensities) const {
  const auto plane = [&](int line) {
    return intensities.data() + static_cast<std::ptrdiff_t>(line) * samples_;
  };
  rows.raw.assign(3 * (stride_ + 2 * kPad), 0);
  rows.lines.resize((2 * lateral_taps_ + 1) * 3 * stride_);
  rows.ratio.assign(stride_ + 2 * kPad, 0);
  const int ahead = static_cast<int>(lateral_taps_);
  // A line is smeared along as soon as it comes, and across once the lines its bell reaches are
  // there; its intensities have then been read by all who need them.
  for (int i = 0; i < lines_ + ahead; ++i) {
    if (i < lines_) alongLine(sums.line(i), plane(i), rows, smeared(rows, i));
    const int done = i - ahead;
    if (done < 0) continue;
    acrossLines(done, rows);
    finish(rows, plane(done));
  }
}

}  // namespace echocine
