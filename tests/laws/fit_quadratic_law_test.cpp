// Quadratics of a fit: differences, regressions, sums and their minimum.

#include <gtest/gtest.h>

#include <numeric>

#include "core/hash_random.h"
#include "fit/quadratic.h"

namespace echocine::fit {
namespace {

Quadratic bowl() {
  Quadratic q(2);
  q.gradient = {-3, 1};
  q.hessian = {2, 0.8, 0.8, 1};
  return q;
}

// The minimum solves H u = -g; at a limit the other unknown has its own minimum there.
TEST(FitQuadratic, TheMinimumIsThatOfTheSystem) {
  const Quadratic q = convex(bowl(), 1e-6);
  const double determinant = 2 * 1 - 0.8 * 0.8;
  const std::vector<double> u = minimumWithin(q, {-9, -9}, {9, 9});
  EXPECT_NEAR(u[0], (1 * 3 + 0.8 * 1) / determinant, 1e-6);
  EXPECT_NEAR(u[1], (-0.8 * 3 - 2 * 1) / determinant, 1e-6);
  const std::vector<double> held = minimumWithin(q, {-1, -9}, {1, 9});
  EXPECT_EQ(held[0], 1);
  EXPECT_NEAR(held[1], -1 - 0.8, 1e-9);
  EXPECT_LT(q.at(u), q.at(held));
}

TEST(FitQuadratic, CovarianceIsTheInverseCurvature) {
  const std::vector<double> c = covarianceOf(convex(bowl(), 1e-6));
  const double determinant = 2 * 1 - 0.8 * 0.8;
  EXPECT_NEAR(c[0], 1 / determinant, 1e-9);
  EXPECT_NEAR(c[1], -0.8 / determinant, 1e-9);
  EXPECT_NEAR(c[3], 2 / determinant, 1e-9);
}

// Differences of a quadratic function are exact. With kept mixed derivatives the rest is anew.
TEST(FitQuadratic, DifferencesOfAQuadraticAreExact) {
  Quadratic q(3);
  q.value = 5;
  q.gradient = {-3, 0, 1};
  q.hessian = {2, 0, 0.8, 0, 0, 0, 0.8, 0, 1};
  std::size_t evaluations = 0;
  const auto values = [&](const std::vector<std::vector<double>>& places) {
    std::vector<double> out;
    for (const std::vector<double>& place : places) out.push_back(q.at(place));
    evaluations = places.size();
    return out;
  };
  const Quadratic found = differencesOf(3, {0, 2}, values);
  EXPECT_EQ(evaluations, 6u);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(found.hessian[i], q.hessian[i], 1e-12);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found.gradient[i], q.gradient[i], 1e-12);
  q.hessian = {4, 0, 0.1, 0, 0, 0, 0.1, 0, 1};
  const Quadratic kept = differencesOf(3, {0, 2}, values, &found);
  EXPECT_EQ(evaluations, 5u);
  EXPECT_NEAR(kept.hessian[0], 4, 1e-12);
  EXPECT_NEAR(kept.hessian[2], 0.8, 1e-12);
}

double drawn(int n, int i) {
  return 2 * uniformFromHash(hashOf(n, i, 22)) - 1;
}

// A quadratic function is found exactly, whatever the weights; unknowns that are not listed are
// ignored, and coefficients that no place shows are 0.
TEST(FitQuadratic, ARegressionOfAQuadraticIsExact) {
  Quadratic q(3);
  q.value = 5;
  q.gradient = {-3, 0, 1};
  q.hessian = {2, 0, 0.8, 0, 0, 0, 0.8, 0, 1};
  std::vector<WeightedValue> values;
  for (int n = 0; n < 9; ++n) {
    const std::vector<double> u{drawn(n, 0), drawn(n, 1), drawn(n, 2)};
    values.push_back({u, q.at(u), 0.1 + n});
  }
  const Quadratic found = regressionOf(3, {0, 2}, values);
  EXPECT_NEAR(found.value, 5, 1e-12);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found.gradient[i], q.gradient[i], 1e-12);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(found.hessian[i], q.hessian[i], 1e-12);
  for (WeightedValue& one : values) one.u[2] = 0, one.value = q.at(one.u);
  const Quadratic open = regressionOf(3, {0, 2}, values);
  EXPECT_NEAR(open.gradient[0], q.gradient[0], 1e-12);
  EXPECT_NEAR(open.hessian[0], q.hessian[0], 1e-12);
  EXPECT_NEAR(open.gradient[2], 0, 1e-12);
  EXPECT_NEAR(open.hessian[2], 0, 1e-12);
  // Fewer values than the six coefficients: the least of the quadratics through them.
  const Quadratic constant = regressionOf(3, {0, 2}, {{{0, 0, 0}, 5, 2}});
  EXPECT_NEAR(constant.value, 5, 1e-12);
  for (const double one : constant.gradient) EXPECT_NEAR(one, 0, 1e-12);
  const Quadratic line = regressionOf(3, {0, 2}, {{{1, 0, 0}, 3, 1}, {{-1, 0, 0}, -3, 1}});
  EXPECT_NEAR(line.gradient[0], 3, 1e-12);
  EXPECT_NEAR(line.value, 0, 1e-12);
  EXPECT_NEAR(line.hessian[0], 0, 1e-12);
}

TEST(FitQuadratic, AMovedOriginKeepsTheFunction) {
  const std::vector<double> origin{0.7, -0.4}, u{-0.2, 0.5};
  const Quadratic moved = bowl().movedTo(origin);
  EXPECT_NEAR(moved.at(u), bowl().at({origin[0] + u[0], origin[1] + u[1]}), 1e-12);
  EXPECT_EQ(moved.hessian, bowl().hessian);
}

// Noise on the values of a bowl moves the minimum of a regression through 48 places less than that
// of differences: two thirds less here, in the mean over 30 draws.
TEST(FitQuadratic, ARegressionAveragesNoise) {
  constexpr std::size_t kN = 7;
  constexpr double kNoise = 0.3;
  const auto f = [](const std::vector<double>& u, int seed) {
    double sum = kNoise * normalFromHashes(hashOf(seed, 1), hashOf(seed, 2));
    for (std::size_t i = 0; i < kN; ++i) sum += 0.5 * u[i] * u[i];
    return sum;
  };
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < kN; ++i) all.push_back(i);
  const std::vector<double> low(kN, -2), high(kN, 2);
  const auto errorOf = [&](const Quadratic& q) {
    const std::vector<double> u = minimumWithin(convex(q, 0.1), low, high);
    return std::inner_product(u.begin(), u.end(), u.begin(), 0.0);
  };
  double differences = 0, regression = 0;
  for (int seed = 0; seed < 30; ++seed) {
    int next = 1000 * seed;
    differences += errorOf(differencesOf(kN, all, [&](const auto& places) {
      std::vector<double> out;
      for (const std::vector<double>& place : places) out.push_back(f(place, ++next));
      return out;
    }));
    std::vector<WeightedValue> values;
    for (int n = 0; n < 48; ++n) {
      std::vector<double> u;
      for (std::size_t i = 0; i < kN; ++i)
        u.push_back(1.5 * normalFromHashes(hashOf(seed, n, i, 3), hashOf(seed, n, i, 4)));
      values.push_back({u, f(u, ++next), 1});
    }
    regression += errorOf(regressionOf(kN, all, values));
  }
  EXPECT_LT(regression, 0.4 * differences);
}

// Views with noisy curvatures, some negative: no further view widens the SD of any unknown.
TEST(FitQuadratic, AFurtherViewNeverWidens) {
  constexpr std::size_t kN = 6;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Quadratic prior(kN);
    for (std::size_t i = 0; i < kN; ++i) prior.bend(i, i) = 0.3;
    std::vector<Quadratic> views;
    std::vector<double> before = covarianceOf(prior);
    bool saddle = false;
    for (std::uint64_t v = 0; v < 3; ++v) {
      Quadratic view(kN);
      for (std::size_t i = 0; i < kN; ++i)
        for (std::size_t j = 0; j <= i; ++j)
          view.bend(i, j) = view.bend(j, i) =
              (i == j ? 1 : 0) + 4 * uniformFromHash(hashOf(seed, v, i, j)) - 2;
      saddle = saddle || convex(view, 0).hessian != view.hessian;
      views.push_back(view);
      const std::vector<double> after = covarianceOf(sumOfViews(prior, views));
      for (std::size_t i = 0; i < kN; ++i) {
        EXPECT_GT(after[i * kN + i], 0);
        EXPECT_LE(after[i * kN + i], before[i * kN + i] * (1 + 1e-9));
      }
      before = after;
    }
    EXPECT_TRUE(saddle);
  }
}

// A saddle gets the least curvature along its falling direction and keeps the other.
TEST(FitQuadratic, ASaddleBecomesConvex) {
  Quadratic q(2);
  q.hessian = {0, 2, 2, 0};  // eigenvalues 2 and -2
  const Quadratic mended = convex(q, 0.1);
  EXPECT_NEAR(mended.hessian[0], (2 + 0.1) / 2, 1e-9);
  EXPECT_NEAR(mended.hessian[1], (2 - 0.1) / 2, 1e-9);
}

}  // namespace
}  // namespace echocine::fit
