#include "motion/interior/quadratic_fit.h"

#include <cmath>

namespace echocine {

namespace {

using Terms = QuadraticFit::Terms;
constexpr std::size_t kTerms = QuadraticFit::kTerms;
using TermMatrix = std::array<Terms, kTerms>;

// Against the mean square of the samples' terms. Our choices: a bending block keeps 99 % of its
// quadratic part; a surface within a tenth of a quadric adds at most five times what it leaves.
constexpr double kProductRidge = 0.01, kTermRidge = 1e-9;

// The lower factor L of m = L L^T.
TermMatrix choleskyFactor(const TermMatrix& m) {
  TermMatrix l{};
  for (std::size_t i = 0; i < kTerms; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = m[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = i == j ? std::sqrt(sum) : sum / l[j][j];
    }
  return l;
}

Terms solved(const TermMatrix& l, Terms b) {
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t j = 0; j < i; ++j) b[i] -= l[i][j] * b[j];
    b[i] /= l[i][i];
  }
  for (std::size_t i = kTerms; i-- > 0;) {
    for (std::size_t j = i + 1; j < kTerms; ++j) b[i] -= l[j][i] * b[j];
    b[i] /= l[i][i];
  }
  return b;
}

}  // namespace

Terms QuadraticFit::termsAt(Vec3d place_m) const {
  const Vec3d s = (1 / size_m) * (place_m - middle);
  return {1, s.x, s.y, s.z, s.x * s.x, s.y * s.y, s.z * s.z, s.y * s.z, s.z * s.x, s.x * s.y};
}

QuadraticFit quadraticFit(std::span<const Vec3f> points_m, std::span<const LatticeSample> samples,
                          std::span<const float> values, std::size_t columns) {
  QuadraticFit fit;
  double total = 0, spread = 0;
  const auto weightOf = [&](std::size_t j) { return static_cast<double>(samples[j].weight); };
  for (std::size_t j = 0; j < points_m.size(); ++j) {
    total += weightOf(j);
    fit.middle = fit.middle + weightOf(j) * toDouble(points_m[j]);
  }
  fit.middle = (1 / total) * fit.middle;
  for (std::size_t j = 0; j < points_m.size(); ++j) {
    const Vec3d p = toDouble(points_m[j]) - fit.middle;
    spread += weightOf(j) * dot(p, p);
  }
  fit.size_m = std::sqrt(spread / (3 * total)) + 1e-12;
  TermMatrix normal{};
  fit.factors.assign(columns, Terms{});
  for (std::size_t j = 0; j < points_m.size(); ++j) {
    const Terms terms = fit.termsAt(toDouble(points_m[j]));
    const double w = weightOf(j) / total;
    for (std::size_t a = 0; a < kTerms; ++a) {
      for (std::size_t b = 0; b < kTerms; ++b) normal[a][b] += w * terms[a] * terms[b];
      for (std::size_t c = 0; c < columns; ++c)
        fit.factors[c][a] += w * terms[a] * static_cast<double>(values[j * columns + c]);
    }
  }
  for (std::size_t a = 0; a < kTerms; ++a) normal[a][a] += a < 4 ? kTermRidge : kProductRidge;
  const TermMatrix factor = choleskyFactor(normal);
  for (Terms& of_column : fit.factors) of_column = solved(factor, of_column);
  return fit;
}

std::vector<float> takeQuadratic(std::span<const Vec3f> points_m,
                                 std::span<const LatticeSample> samples,
                                 std::span<const Vec3d> node_places_m, std::size_t columns,
                                 std::span<float> values) {
  const QuadraticFit fit = quadraticFit(points_m, samples, values, columns);
  std::vector<float> at_nodes;
  at_nodes.reserve(node_places_m.size() * columns);
  for (const Vec3d place_m : node_places_m) {
    const Terms terms = fit.termsAt(place_m);
    for (const Terms& factors : fit.factors) {
      double sum = 0;
      for (std::size_t k = 0; k < kTerms; ++k) sum += factors[k] * terms[k];
      at_nodes.push_back(static_cast<float>(sum));
    }
  }
  for (std::size_t j = 0; j < samples.size(); ++j)
    for (std::size_t i = 0; i < 8; ++i) {
      const float* const at = &at_nodes[samples[j].node[i] * columns];
      for (std::size_t c = 0; c < columns; ++c)
        values[j * columns + c] -= samples[j].share[i] * at[c];
    }
  return at_nodes;
}

}  // namespace echocine
