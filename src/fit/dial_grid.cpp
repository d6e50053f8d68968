#include "fit/dial_grid.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "core/error.h"
#include "core/parallel.h"
#include "fit/counted_steps.h"

namespace echocine::fit {

std::vector<double> ScanAxis::values() const {
  std::vector<double> out;
  const int steps = static_cast<int>(std::floor((range.high - range.low) / step + 1e-6));
  for (int i = 0; i <= steps; ++i) out.push_back(range.low + step * i);
  return out;
}

int nodesFor(std::size_t axes) {
  return axes >= kMostAxes ? 3 : 4;
}

std::vector<double> middleOf(const std::vector<ScanAxis>& axes) {
  std::vector<double> middle;
  for (const ScanAxis& axis : axes) middle.push_back(0.5 * (axis.range.low + axis.range.high));
  return middle;
}

namespace {

std::vector<ScanPoint> pointsOf(const std::vector<ScanAxis>& axes) {
  std::vector<ScanPoint> points{{}};
  for (const ScanAxis& axis : axes) {
    std::vector<ScanPoint> next;
    for (const ScanPoint& point : points)
      for (const double value : axis.values()) {
        next.push_back(point);
        next.back().values.push_back(value);
      }
    points = std::move(next);
  }
  return points;
}

// Least squares of a paraboloid in steps about the best point. Two values of an axis have no
// curvature: such axes are held at the best point.
void fitParaboloid(const std::vector<ScanAxis>& all, DialGrid& grid) {
  std::vector<std::size_t> fitted, held;
  for (std::size_t a = 0; a < all.size(); ++a)
    (all[a].values().size() > 2 ? fitted : held).push_back(a);
  const std::size_t n = fitted.size(), unknowns = 1 + n + n * (n + 1) / 2;
  const std::vector<double>& best = grid.points[grid.best].values;
  const auto steps = [&](const ScanPoint& p, std::size_t i) {
    return (p.values[fitted[i]] - best[fitted[i]]) / all[fitted[i]].step;
  };
  cv::Mat rows(0, static_cast<int>(unknowns), CV_64F), right(0, 1, CV_64F);
  for (const ScanPoint& p : grid.points) {
    cv::Mat row(1, static_cast<int>(unknowns), CV_64F);
    int at = 0;
    bool near = std::all_of(held.begin(), held.end(),
                            [&](std::size_t a) { return p.values[a] == best[a]; });
    row.at<double>(at++) = 1;
    for (std::size_t a = 0; a < n; ++a) {
      near = near && std::abs(steps(p, a)) < 2.5;
      row.at<double>(at++) = steps(p, a);
    }
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b <= a; ++b) row.at<double>(at++) = steps(p, a) * steps(p, b);
    if (!near) continue;
    rows.push_back(row);
    right.push_back(p.found.discrepancy);
  }
  if (n == 0 || rows.rows <= static_cast<int>(unknowns)) return;
  cv::Mat x, hessian(static_cast<int>(n), static_cast<int>(n), CV_64F), values, move;
  if (!cv::solve(rows, right, x, cv::DECOMP_SVD) || !cv::checkRange(x)) return;
  int at = 1 + static_cast<int>(n);
  for (int a = 0; a < static_cast<int>(n); ++a)
    for (int b = 0; b <= a; ++b, ++at)
      hessian.at<double>(a, b) = hessian.at<double>(b, a) = x.at<double>(at) * (a == b ? 2 : 1);
  const bool is_whole = held.empty();  // else only the minimum is known
  for (int a = 0; is_whole && a < static_cast<int>(n); ++a)
    grid.curvature.push_back(hessian.at<double>(a, a));
  if (!cv::eigen(hessian, values) || !(values.at<double>(values.rows - 1) > 0)) return;
  // Correlations of the dials' errors, from the inverse.
  cv::Mat inverse;
  if (cv::invert(hessian, inverse) == 0 || !cv::checkRange(inverse)) return;
  for (int a = 0; is_whole && a < static_cast<int>(n); ++a) {
    grid.confounding.emplace_back();
    for (int b = 0; b < static_cast<int>(n); ++b)
      grid.confounding.back().push_back(
          inverse.at<double>(a, b) /
          std::sqrt(inverse.at<double>(a, a) * inverse.at<double>(b, b)));
  }
  move = -inverse * x.rowRange(1, 1 + static_cast<int>(n));
  grid.minimum = best;
  for (std::size_t i = 0; i < n; ++i) {
    const ScanAxis& axis = all[fitted[i]];
    grid.minimum[fitted[i]] =
        std::clamp(best[fitted[i]] + move.at<double>(static_cast<int>(i)) * axis.step,
                   axis.range.low, axis.range.high);
  }
}

}  // namespace

DialGrid holdGrid(const std::vector<ScanAxis>& axes, const HeartFamily& family,
                  const ModelDiscrepancy& discrepancy, const std::vector<FitPose>& starts,
                  const PlaneTilt& tilt, const Monitor& monitor) {
  DialGrid grid;
  grid.points = pointsOf(axes);
  CountedSteps steps(monitor, grid.points.size());
  parallelBlocks(grid.points.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!steps.next()) throw JobError("stopped while dials were scanned");
      grid.points[i].found = discrepancy.refine(family.at(grid.points[i].values, tilt), starts);
      steps.done();
    }
  });
  for (std::size_t i = 0; i < grid.points.size(); ++i)
    if (grid.points[i].found.discrepancy < grid.points[grid.best].found.discrepancy) grid.best = i;
  fitParaboloid(axes, grid);
  return grid;
}

}  // namespace echocine::fit
