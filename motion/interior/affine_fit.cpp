#include "motion/interior/affine_fit.h"

namespace echocine {

namespace {

using Matrix3 = double[3][3];

// Solves m x = b for symmetric positive m, by cofactors.
Vec3d solved(const Matrix3& m, Vec3d b) {
  const Vec3d r0{m[0][0], m[0][1], m[0][2]}, r1{m[1][0], m[1][1], m[1][2]},
      r2{m[2][0], m[2][1], m[2][2]};
  const double det = dot(r0, cross(r1, r2));
  return (1 / det) * (b.x * cross(r1, r2) + b.y * cross(r2, r0) + b.z * cross(r0, r1));
}

}  // namespace

AffineFit affineFit(std::span<const Vec3f> points_m, std::span<const LatticeSample> samples,
                    std::span<const float> values, std::size_t columns) {
  double total = 0;
  AffineFit fit{{}, std::vector<double>(columns, 0.0), {}};
  for (std::size_t j = 0; j < points_m.size(); ++j) {
    const auto w = static_cast<double>(samples[j].weight);
    total += w;
    fit.middle = fit.middle + w * toDouble(points_m[j]);
    for (std::size_t c = 0; c < columns; ++c)
      fit.mean[c] += w * static_cast<double>(values[j * columns + c]);
  }
  fit.middle = (1 / total) * fit.middle;
  for (double& m : fit.mean) m /= total;
  Matrix3 spread{};
  std::vector<Vec3d> moment(columns);
  for (std::size_t j = 0; j < points_m.size(); ++j) {
    const auto w = static_cast<double>(samples[j].weight);
    const Vec3d p = toDouble(points_m[j]) - fit.middle;
    const double at[3] = {p.x, p.y, p.z};
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) spread[a][b] += w * at[a] * at[b];
    for (std::size_t c = 0; c < columns; ++c)
      moment[c] =
          moment[c] + (w * (static_cast<double>(values[j * columns + c]) - fit.mean[c])) * p;
  }
  // Holds the slopes that flat or few points leave open at 0.
  const double ridge = 1e-9 * (spread[0][0] + spread[1][1] + spread[2][2]) + 1e-30;
  for (std::size_t a = 0; a < 3; ++a) spread[a][a] += ridge;
  fit.slope.resize(columns);
  for (std::size_t c = 0; c < columns; ++c) fit.slope[c] = solved(spread, moment[c]);
  return fit;
}

}  // namespace echocine
