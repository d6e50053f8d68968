#include "motion/interior/motion_modes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace echocine {

namespace {

using Matrix = std::vector<std::vector<double>>;

// Eigenvectors of a symmetric matrix, which becomes diagonal, by Jacobi's rotations.
Matrix diagonalise(Matrix& a) {
  const std::size_t n = a.size();
  Matrix vectors(n, std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < n; ++i) vectors[i][i] = 1;
  const auto rotate = [n](Matrix& m, std::size_t p, std::size_t q, double c, double s) {
    for (std::size_t i = 0; i < n; ++i) {
      const double left = m[i][p], right = m[i][q];
      m[i][p] = c * left - s * right;
      m[i][q] = s * left + c * right;
    }
  };
  const auto turnRows = [n](Matrix& m, std::size_t p, std::size_t q, double c, double s) {
    for (std::size_t i = 0; i < n; ++i) {
      const double upper = m[p][i], lower = m[q][i];
      m[p][i] = c * upper - s * lower;
      m[q][i] = s * upper + c * lower;
    }
  };
  constexpr int kSweeps = 12;  // they converge quadratically: fewer than ten do at this size
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (std::size_t p = 0; p < n; ++p)
      for (std::size_t q = p + 1; q < n; ++q) {
        if (a[p][q] == 0) continue;
        const double theta = 0.5 * std::atan2(2 * a[p][q], a[q][q] - a[p][p]);
        const double c = std::cos(theta), s = std::sin(theta);
        rotate(a, p, q, c, s);
        turnRows(a, p, q, c, s);
        rotate(vectors, p, q, c, s);
      }
  return vectors;
}

Matrix gram(std::span<const Vec3f> displacement_m, std::size_t keyframes) {
  Matrix products(keyframes, std::vector<double>(keyframes, 0.0));
  std::vector<double> x(keyframes), y(keyframes), z(keyframes);
  for (std::size_t start = 0; start < displacement_m.size(); start += keyframes) {
    for (std::size_t k = 0; k < keyframes; ++k) {
      const Vec3d d = toDouble(displacement_m[start + k]);
      x[k] = d.x;
      y[k] = d.y;
      z[k] = d.z;
    }
    for (std::size_t i = 0; i < keyframes; ++i) {
      double* const to = products[i].data();
      for (std::size_t j = i; j < keyframes; ++j) to[j] += x[i] * x[j] + y[i] * y[j] + z[i] * z[j];
    }
  }
  for (std::size_t i = 0; i < keyframes; ++i)
    for (std::size_t j = 0; j < i; ++j) products[i][j] = products[j][i];
  return products;
}

}  // namespace

MotionModes motionModes(std::span<const Vec3f> displacement_m, std::size_t keyframes,
                        double tolerance_m) {
  Matrix products = gram(displacement_m, keyframes);
  const Matrix vectors = diagonalise(products);
  const auto points =
      static_cast<double>(displacement_m.size() / std::max<std::size_t>(keyframes, 1));
  std::vector<std::size_t> kept;
  for (std::size_t m = 0; m < keyframes; ++m)
    if (products[m][m] > tolerance_m * tolerance_m * points) kept.push_back(m);
  std::sort(kept.begin(), kept.end(),
            [&](std::size_t a, std::size_t b) { return products[a][a] > products[b][b]; });
  MotionModes modes;
  modes.count = kept.size();
  for (std::size_t k = 0; k < keyframes; ++k) {
    std::vector<double>& row = modes.keyframe_from_mode.emplace_back();
    for (const std::size_t m : kept) row.push_back(vectors[k][m]);
  }
  for (std::size_t start = 0; start < displacement_m.size(); start += keyframes)
    for (const std::size_t m : kept) {
      Vec3d sum;
      for (std::size_t k = 0; k < keyframes; ++k)
        sum = sum + vectors[k][m] * toDouble(displacement_m[start + k]);
      modes.shapes_m.push_back(toFloat(sum));
    }
  return modes;
}

}  // namespace echocine
