#include "compare/wall_edges.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/check.h"

namespace echocine::compare {

// Central differences, per hundredth of the depth, so that loops of any scale compare.
EdgeField edgesOf(const echo::BeamGrid& lattice, std::span<const float> smooth,
                  std::span<const float> weights, double depth) {
  EdgeField out;
  out.along.assign(lattice.size(), 0);
  out.across.assign(lattice.size(), 0);
  out.weight.assign(lattice.size(), 0);
  const auto samples = static_cast<std::size_t>(lattice.samples);
  const double hundredth = 0.01 * depth, dr = (lattice.far - lattice.near) / lattice.samples,
               da = (lattice.last_rad - lattice.first_rad) / std::max(1, lattice.lines - 1);
  const auto per_sample = static_cast<float>(hundredth / (2 * dr));
  std::vector<float> per_line;
  for (int k = 0; k < lattice.samples; ++k)
    per_line.push_back(static_cast<float>(hundredth / (2 * da * lattice.depth(k))));
  for (int i = 1; i + 1 < lattice.lines; ++i)
    for (std::size_t k = 1; k + 1 < samples; ++k) {
      const std::size_t at = static_cast<std::size_t>(i) * samples + k;
      const float least = std::min({weights[at], weights[at - 1], weights[at + 1],
                                    weights[at - samples], weights[at + samples]});
      if (!(least > 0)) continue;
      out.weight[at] = least;
      out.along[at] = per_sample * (smooth[at + 1] - smooth[at - 1]);
      out.across[at] = per_line[k] * (smooth[at + samples] - smooth[at - samples]);
    }
  return out;
}

// Eq. 1 of wall_edges.h, of samples that both fields have.
double edgeCorrelation(const EdgeField& x, const EdgeField& y) {
  CHECK_EQ(x.weight.size(), y.weight.size());
  double n = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < x.weight.size(); ++i) {
    if (!(x.weight[i] > 0 && y.weight[i] > 0)) continue;
    const double w = x.weight[i], a = x.along[i], b = x.across[i], c = y.along[i], d = y.across[i];
    n += w;
    xx += w * (a * a + b * b);
    yy += w * (c * c + d * d);
    xy += w * (a * c + b * d);
  }
  const double least = 1e-6 * n;  // a thousandth of a grey per hundredth: rounding, no edges
  if (xx <= least || yy <= least) return n > 0 && xx <= least && yy <= least ? 1 : 0;
  return std::clamp(xy / std::sqrt(xx * yy), -1.0, 1.0);
}

WallEdges::WallEdges(const echo::BeamGrid& g, std::span<const float> weights)
    : grid_(g), lattice_(g), depth_(g.far), weights_(weights.begin(), weights.end()) {
  // Smoothed by sigma, greys are the same within sigma / 2: the lattice is as coarse as that
  // allows, and a call as quick.
  const double sigma = kSmoothingShare * g.far, sample = (g.far - g.near) / g.samples;
  const double line_rad = (g.last_rad - g.first_rad) / std::max(1, g.lines - 1),
               line = line_rad * 0.5 * (g.near + g.far);
  // At least 8 blocks each way, whatever the grid.
  const auto block = [&](double spacing, int count) {
    return std::clamp(static_cast<int>(0.5 * sigma / spacing), 1, std::max(1, count / 8));
  };
  line_block_ = block(line, g.lines);
  sample_block_ = block(sample, g.samples);
  lattice_.lines = g.lines / line_block_;
  lattice_.samples = g.samples / sample_block_;
  first_line_ = (g.lines - lattice_.lines * line_block_) / 2;  // the rest, on both sides
  first_sample_ = (g.samples - lattice_.samples * sample_block_) / 2;
  lattice_.first_rad = g.first_rad + line_rad * (first_line_ + 0.5 * (line_block_ - 1));
  lattice_.last_rad = lattice_.first_rad + line_rad * line_block_ * (lattice_.lines - 1);
  lattice_.near = g.near + sample * first_sample_;
  lattice_.far = lattice_.near + sample * sample_block_ * lattice_.samples;
  along_ = sigma / (sample * sample_block_);
  across_ = sigma / (line * line_block_);
  block_weights_.assign(lattice_.size(), 0);
  const auto samples = static_cast<std::size_t>(g.samples),
             blocks = static_cast<std::size_t>(lattice_.samples);
  for (int i = 0; i < lattice_.lines * line_block_; ++i)
    for (int k = 0; k < lattice_.samples * sample_block_; ++k)
      block_weights_[static_cast<std::size_t>(i / line_block_) * blocks +
                     static_cast<std::size_t>(k / sample_block_)] +=
          weights_[static_cast<std::size_t>(i + first_line_) * samples +
                   static_cast<std::size_t>(k + first_sample_)];
  share_ = block_weights_;
  smooth(share_);
  // Greys are smoothed with their weights and divided by the smoothed weights (normalised
  // convolution, Knutsson and Westin 1993): no edge arises at the border of the area, and greys
  // change evenly as it moves.
  for (float& s : share_) s = std::max(s, 1e-6f);
}

void WallEdges::smooth(std::vector<float>& values) const {
  cv::Mat m(lattice_.lines, lattice_.samples, CV_32F, values.data());
  cv::GaussianBlur(m, m, {0, 0}, along_, across_, cv::BORDER_CONSTANT);
}

EdgeField WallEdges::operator()(std::span<const float> frame) const {
  CHECK_EQ(frame.size(), weights_.size());
  std::vector<float> u(lattice_.size(), 0);
  const auto samples = static_cast<std::size_t>(grid_.samples),
             blocks = static_cast<std::size_t>(lattice_.samples);
  for (int i = 0; i < lattice_.lines * line_block_; ++i) {
    const std::size_t line = static_cast<std::size_t>(i + first_line_) * samples +
                             static_cast<std::size_t>(first_sample_);
    const float *grey = frame.data() + line, *weight = weights_.data() + line;
    float* out = u.data() + static_cast<std::size_t>(i / line_block_) * blocks;
    for (std::size_t b = 0; b < blocks; ++b)
      for (int s = 0; s < sample_block_; ++s, ++grey, ++weight) out[b] += *weight * *grey;
  }
  smooth(u);
  for (std::size_t b = 0; b < u.size(); ++b) u[b] /= share_[b];
  return edgesOf(lattice_, u, block_weights_, depth_);
}

}  // namespace echocine::compare
