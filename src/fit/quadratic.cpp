#include "fit/quadratic.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace echocine::fit {

double Quadratic::at(const std::vector<double>& u) const {
  double sum = value;
  for (std::size_t i = 0; i < size(); ++i) {
    sum += gradient[i] * u[i];
    for (std::size_t j = 0; j < size(); ++j) sum += 0.5 * u[i] * hessian[i * size() + j] * u[j];
  }
  return sum;
}

Quadratic convex(const Quadratic& q, double least) {
  const int n = static_cast<int>(q.size());
  const cv::Mat hessian = cv::Mat(q.hessian, true).reshape(1, n);
  cv::Mat values, rows;
  cv::eigen(0.5 * (hessian + hessian.t()), values, rows);
  for (int i = 0; i < n; ++i) values.at<double>(i) = std::max(values.at<double>(i), least);
  const cv::Mat all = rows.t() * cv::Mat::diag(values) * rows;
  Quadratic out = q;
  out.hessian.assign(all.begin<double>(), all.end<double>());
  return out;
}

std::vector<double> minimumWithin(const Quadratic& q, const std::vector<double>& low,
                                  const std::vector<double>& high) {
  const std::size_t n = q.size();
  std::vector<double> u(n);
  for (std::size_t i = 0; i < n; ++i) u[i] = std::clamp(0.0, low[i], high[i]);
  constexpr int kMostSweeps = 2000;
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double moved = 0;
    for (std::size_t i = 0; i < n; ++i) {
      double slope = q.gradient[i];
      for (std::size_t j = 0; j < n; ++j) slope += q.hessian[i * n + j] * u[j];
      const double next = std::clamp(u[i] - slope / q.hessian[i * n + i], low[i], high[i]);
      moved = std::max(moved, std::abs(next - u[i]));
      u[i] = next;
    }
    if (moved < 1e-9) break;
  }
  return u;
}

std::vector<double> covarianceOf(const Quadratic& q) {
  cv::Mat inverse;
  cv::invert(cv::Mat(q.hessian, true).reshape(1, static_cast<int>(q.size())), inverse,
             cv::DECOMP_SVD);
  return {inverse.begin<double>(), inverse.end<double>()};
}

}  // namespace echocine::fit
