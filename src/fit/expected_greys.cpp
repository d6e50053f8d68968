#include "fit/expected_greys.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/check.h"
#include "core/parallel.h"

namespace echocine::fit {

namespace {

// SD of the Gaussian in cells, about 5 mm: half a wall. Our choice.
constexpr double kSpread_cells = 2;
constexpr int kReach_cells = 5;
// w_0 of Eq. 21: residuals of fewer cells than this are hardly believed. Our choice.
constexpr double kFewCells = 2;

// A tissue's sums of w r and w, by cell of a frame.
struct CellSums {
  std::vector<double> residual, weight;
};

// Adds the neighbours of each cell, weighted by a Gaussian that is 1 at the cell itself.
void blur(const ModelLoop& model, std::vector<double>& cells) {
  static const cv::Mat kernel = [] {
    const cv::Mat even = cv::getGaussianKernel(2 * kReach_cells + 1, kSpread_cells, CV_64F);
    return cv::Mat(even / even.at<double>(kReach_cells));
  }();
  const cv::Mat all(model.cells_across, model.cells_along, CV_64F, cells.data());
  cv::sepFilter2D(all.clone(), all, CV_64F, kernel, kernel, {-1, -1}, 0, cv::BORDER_CONSTANT);
}

CellSums sumsOf(std::size_t tissue, std::size_t frame, const ModelLoop& model,
                const std::vector<FitMap>& maps) {
  CellSums out{std::vector<double>(model.frames[frame].cells.size()), {}};
  out.weight = out.residual;
  static const std::vector<RegionLeft> none;  // nothing is seen
  for (const FitMap& map : maps)
    for (const RegionLeft& r : map.region.empty() ? none : map.region[frame]) {
      const double share = r.share,
                   w = (r.first == tissue ? share : 0) + (r.second == tissue ? 1 - share : 0);
      if (!(w > 0) || !std::isfinite(r.left)) continue;
      out.residual[r.cell] += w * static_cast<double>(r.left);
      out.weight[r.cell] += w;
    }
  blur(model, out.residual);
  blur(model, out.weight);
  return out;
}

}  // namespace

ExpectedGreys::ExpectedGreys(const ModelLoop& model, const std::vector<FitMap>& maps)
    : tissues_(model.tissues.size()),
      frames_(model.frames.size()),
      cells_(model.frames.front().cells.size()),
      field_(tissues_ * frames_ * cells_) {
  parallelBlocks(tissues_, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      std::vector<CellSums> sums;
      for (std::size_t n = 0; n < frames_; ++n) sums.push_back(sumsOf(t, n, model, maps));
      for (std::size_t n = 0; n < frames_; ++n) {
        const CellSums &before = sums[(n + frames_ - 1) % frames_], &here = sums[n],
                       &after = sums[(n + 1) % frames_];
        float* const field = &field_[(t * frames_ + n) * cells_];
        for (std::size_t c = 0; c < cells_; ++c)
          field[c] = static_cast<float>(
              (before.residual[c] + 2 * here.residual[c] + after.residual[c]) /
              (before.weight[c] + 2 * here.weight[c] + after.weight[c] + kFewCells));
      }
    }
  });
}

double ExpectedGreys::of(const TissueCell& cell, std::size_t frame, std::size_t number) const {
  const auto at = [&](std::size_t tissue) -> double {
    return field_[(tissue * frames_ + frame) * cells_ + number];
  };
  const double share = cell.share;
  return share * at(cell.first) + (1 - share) * at(cell.second);
}

void ExpectedGreys::scaleTo(const ModelLoop& model, const FitMap& real) {
  if (field_.empty()) return;
  CHECK_EQ(model.frames.size(), frames_);
  double both = 0, square = 0;
  for (std::size_t n = 0; n < real.region.size(); ++n)
    for (const RegionLeft& r : real.region[n]) {
      if (!std::isfinite(r.left)) continue;
      const TissueCell& cell = model.frames[n].cells[r.cell];
      const double e = of(cell, n, r.cell), area = cell.area;
      both += area * e * static_cast<double>(r.left);
      square += area * e * e;
    }
  shown_ = square > 0 ? std::clamp(both / square, 0.0, 1.0) : 0;
  deviation_ = real.deviation;
}

void ExpectedGreys::applyTo(ModelLoop& model) const {
  if (!(shown_ > 0)) return;
  CHECK_EQ(model.frames.size(), frames_);
  CHECK_EQ(model.frames.front().cells.size(), cells_);
  for (std::size_t n = 0; n < frames_; ++n)
    for (std::size_t c = 0; c < cells_; ++c) {
      TissueCell& cell = model.frames[n].cells[c];
      if (cell.area > 0) cell.expected = static_cast<float>(shown_ * deviation_ * of(cell, n, c));
    }
}

}  // namespace echocine::fit
