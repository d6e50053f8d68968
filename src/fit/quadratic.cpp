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

Quadratic Quadratic::movedTo(const std::vector<double>& origin) const {
  Quadratic out = *this;
  out.value = at(origin);
  for (std::size_t i = 0; i < size(); ++i)
    for (std::size_t j = 0; j < size(); ++j) out.gradient[i] += hessian[i * size() + j] * origin[j];
  return out;
}

Quadratic differencesOf(std::size_t all, const std::vector<std::size_t>& of, const ValuesAt& values,
                        const Quadratic* mixed) {
  std::vector<std::vector<double>> places{std::vector<double>(all, 0)};
  const auto add = [&](std::size_t i, double a, std::size_t j, double b) {
    places.emplace_back(all, 0);
    places.back()[i] += a;
    places.back()[j] += b;
  };
  for (const std::size_t i : of) add(i, 1, i, 0), add(i, -1, i, 0);
  for (std::size_t a = 0; mixed == nullptr && a < of.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) add(of[a], 1, of[b], 1);
  const std::vector<double> y = values(places);
  Quadratic out(all);
  out.value = y[0];
  for (std::size_t a = 0; a < of.size(); ++a) {
    out.gradient[of[a]] = 0.5 * (y[1 + 2 * a] - y[2 + 2 * a]);
    out.bend(of[a], of[a]) = y[1 + 2 * a] - 2 * y[0] + y[2 + 2 * a];
  }
  std::size_t next = 1 + 2 * of.size();
  for (std::size_t a = 0; a < of.size(); ++a)
    for (std::size_t b = 0; b < a; ++b, ++next) {
      const std::size_t i = of[a], j = of[b];
      out.bend(i, j) = out.bend(j, i) =
          mixed != nullptr ? mixed->hessian[i * all + j]
                           : y[next] - y[0] - out.gradient[i] - out.gradient[j] -
                                 0.5 * (out.hessian[i * all + i] + out.hessian[j * all + j]);
    }
  return out;
}

Quadratic regressionOf(std::size_t all, const std::vector<std::size_t>& of,
                       const std::vector<WeightedValue>& values) {
  const std::size_t n = of.size(), terms = 1 + n + n * (n + 1) / 2;
  // cv::solve() needs as many rows as coefficients: rows of zeros leave the solution as it is.
  const auto needed = static_cast<int>(std::max(values.size(), terms));
  cv::Mat rows(needed, static_cast<int>(terms), CV_64F, cv::Scalar(0));
  cv::Mat right(needed, 1, CV_64F, cv::Scalar(0));
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto& [u, value, weight] = values[k];
    const double root = std::sqrt(weight);
    double* row = rows.ptr<double>(static_cast<int>(k));
    *row++ = root;
    for (const std::size_t i : of) *row++ = root * u[i];
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b <= a; ++b)
        *row++ = root * (a == b ? 0.5 : 1.0) * u[of[a]] * u[of[b]];
    right.at<double>(static_cast<int>(k)) = root * value;
  }
  cv::Mat solved;
  cv::solve(rows, right, solved, cv::DECOMP_SVD);
  Quadratic out(all);
  const double* next = solved.ptr<double>();
  out.value = *next++;
  for (const std::size_t i : of) out.gradient[i] = *next++;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b <= a; ++b) out.bend(of[a], of[b]) = out.bend(of[b], of[a]) = *next++;
  return out;
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

Quadratic sumOfViews(const Quadratic& prior, const std::vector<Quadratic>& views) {
  Quadratic sum = prior;
  for (const Quadratic& view : views) {
    const Quadratic one = convex(view, 0);
    sum.value += one.value;
    for (std::size_t i = 0; i < sum.gradient.size(); ++i) sum.gradient[i] += one.gradient[i];
    for (std::size_t i = 0; i < sum.hessian.size(); ++i) sum.hessian[i] += one.hessian[i];
  }
  return sum;
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
