// What holds for interpolation in time whatever the keyframes are.

#include <numbers>
#include <numeric>

#include "motion/keyframes/interpolation.h"
#include "tests/stage/motion_fixtures.h"

namespace echocine::motion_test {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;
std::vector<double> evenPhases(std::size_t n) {
  std::vector<double> phases(n);
  for (std::size_t k = 0; k < n; ++k) phases[k] = static_cast<double>(k) / static_cast<double>(n);
  return phases;
}

// Even, uneven, not starting at 0, and as few as can be.
const std::vector<std::vector<double>> kPhaseSets{evenPhases(25),
                                                  evenPhases(8),
                                                  {0.05, 0.2, 0.31, 0.5, 0.64, 0.81, 0.9},
                                                  {0.1, 0.55},
                                                  {0.0, 0.3, 0.7}};

double interpolated(const KeyframeWeights& weights, const std::vector<double>& values,
                    double phase) {
  std::vector<double> w(values.size());
  weights.at(phase, w);
  return std::inner_product(w.begin(), w.end(), values.begin(), 0.0);
}

template <typename Function>
std::vector<double> sampled(const std::vector<double>& phases, Function f) {
  std::vector<double> values;
  for (const double phase : phases) values.push_back(f(phase));
  return values;
}

// Law: w_j(phase_k) is 1 for j = k and 0 else, exactly, so that a keyframe comes out as its file.
TEST(MotionInterpolationLaw, KeyframesAreReproducedExactly) {
  for (const Interpolation kind : kInterpolations)
    for (const std::vector<double>& phases : kPhaseSets) {
      const KeyframeWeights weights(phases, kind);
      std::vector<double> w(phases.size());
      for (std::size_t k = 0; k < phases.size(); ++k) {
        weights.at(phases[k], w);
        for (std::size_t j = 0; j < w.size(); ++j) EXPECT_EQ(w[j], j == k ? 1.0 : 0.0);
      }
    }
}

// Law: sum w = 1, so that what stands still in all keyframes stands still between them.
TEST(MotionInterpolationLaw, WeightsSumToOne) {
  for (const Interpolation kind : kInterpolations)
    for (const std::vector<double>& phases : kPhaseSets) {
      const KeyframeWeights weights(phases, kind);
      const std::vector<double> ones(phases.size(), 1.0);
      for (int i = 0; i < 997; ++i) ASSERT_NEAR(interpolated(weights, ones, i / 997.0), 1.0, 1e-13);
    }
}

// Law: f(t + 1) = f(t) for any t a caller may give, and continuous around every keyframe.
TEST(MotionInterpolationLaw, PhaseHasPeriodOneAndNoJumpAnywhere) {
  for (const Interpolation kind : kInterpolations)
    for (const std::vector<double>& phases : kPhaseSets) {
      const KeyframeWeights weights(phases, kind);
      const std::vector<double> values = sampled(phases, [](double t) { return std::sin(9 * t); });
      const auto f = [&](double t) { return interpolated(weights, values, t); };
      EXPECT_EQ(f(0.0), f(1.0));
      EXPECT_EQ(f(0.25), f(-3.75));
      EXPECT_NEAR(f(1 - 1e-12), f(0.0), 1e-9);
      EXPECT_NEAR(f(-1e-300), f(0.0), 1e-12);
      for (const double phase : phases)
        for (const double step : {-1e-12, 1e-12}) EXPECT_NEAR(f(phase + step), f(phase), 1e-9);
    }
}

// Largest jump of a derivative at a keyframe, from one-sided differences.
double slopeJump(const KeyframeWeights& weights, const std::vector<double>& values, double phase) {
  constexpr double kStep = 1e-6;
  const auto f = [&](double t) { return interpolated(weights, values, t); };
  const double left = (3 * f(phase) - 4 * f(phase - kStep) + f(phase - 2 * kStep)) / (2 * kStep);
  const double right = (-3 * f(phase) + 4 * f(phase + kStep) - f(phase + 2 * kStep)) / (2 * kStep);
  return std::fabs(right - left);
}

double curvatureJump(const KeyframeWeights& weights, const std::vector<double>& values,
                     double phase) {
  constexpr double kStep = 1e-4;
  const auto f = [&](double t) { return interpolated(weights, values, t); };
  const auto bend = [&](double s) {
    return (2 * f(phase) - 5 * f(phase + s) + 4 * f(phase + 2 * s) - f(phase + 3 * s)) / (s * s);
  };
  return std::fabs(bend(kStep) - bend(-kStep));
}

// C1 for Catmull-Rom and Fourier, C2 for the spline, and no more than the volume curve for the
// cycle: bounds are what one-sided differences of these steps leave.
TEST(MotionInterpolationLaw, AllButLinearAreSmoothAndTheSplineBendsSmoothlyToo) {
  for (const std::vector<double>& phases : kPhaseSets) {
    const std::vector<double> values = sampled(
        phases, [](double t) { return std::cos(kTwoPi * t) + 0.3 * std::sin(5 * kTwoPi * t); });
    for (const Interpolation kind : kInterpolations) {
      if (kind == Interpolation::linear || kind == Interpolation::cycle) continue;
      const KeyframeWeights weights(phases, kind);
      for (const double phase : phases) EXPECT_LT(slopeJump(weights, values, phase), 1e-5);
    }
    const KeyframeWeights spline(phases, Interpolation::spline);
    for (const double phase : phases) EXPECT_LT(curvatureJump(spline, values, phase), 1e-3);
  }
}

// Away from the wrap a straight line in time stays straight; a spline feels the wrap everywhere.
TEST(MotionInterpolationLaw, LocalKindsReproduceStraightLines) {
  const std::vector<double> phases{0.0, 0.1, 0.25, 0.3, 0.5, 0.7, 0.8};
  for (const Interpolation kind : {Interpolation::linear, Interpolation::catmull_rom}) {
    const KeyframeWeights weights(phases, kind);
    const std::vector<double> values = sampled(phases, [](double t) { return 3 * t - 1; });
    for (double t = 0.1; t < 0.7; t += 0.013)
      EXPECT_NEAR(interpolated(weights, values, t), 3 * t - 1, 1e-14);
  }
}

// Slopes at a keyframe are those of the parabola through it and its neighbours, also where they are
// uneven.
TEST(MotionInterpolationLaw, CatmullRomReproducesParabolasBetweenTheirSlopes) {
  const std::vector<double> phases{0.0, 0.1, 0.25, 0.3, 0.5, 0.7, 0.8};
  const KeyframeWeights weights(phases, Interpolation::catmull_rom);
  const std::vector<double> values = sampled(phases, [](double t) { return t * t; });
  for (double t = 0.1; t < 0.7; t += 0.013)
    EXPECT_NEAR(interpolated(weights, values, t), t * t, 1e-14);
}

double largestError(std::size_t n, Interpolation kind) {
  const auto exact = [](double t) { return std::exp(std::sin(kTwoPi * t)); };
  const std::vector<double> phases = evenPhases(n);
  const KeyframeWeights weights(phases, kind);
  const std::vector<double> values = sampled(phases, exact);
  double largest = 0;
  for (int i = 0; i < 5000; ++i)
    largest =
        std::max(largest, std::fabs(interpolated(weights, values, i / 5000.0) - exact(i / 5000.0)));
  return largest;
}

// Halving the spacing divides the error by 2^order; e^sin is smooth and periodic, Fourier has it to
// rounding.
TEST(MotionInterpolationLaw, ErrorsFallWithTheOrderOfTheKind) {
  const auto order = [](Interpolation kind) {
    return std::log2(largestError(32, kind) / largestError(64, kind));
  };
  EXPECT_NEAR(order(Interpolation::linear), 2.0, 0.2);
  EXPECT_NEAR(order(Interpolation::catmull_rom), 3.0, 0.3);
  EXPECT_NEAR(order(Interpolation::spline), 4.0, 0.3);
  EXPECT_LT(largestError(32, Interpolation::fourier), 1e-13);
}

TEST(MotionInterpolationLaw, FourierIsExactForWhatItsKeyframesCanHold) {
  for (const std::size_t n : {5u, 8u, 25u, 64u}) {
    const std::vector<double> phases = evenPhases(n);
    const KeyframeWeights weights(phases, Interpolation::fourier);
    for (std::size_t k = 0; 2 * k < n; ++k) {
      const double harmonic = kTwoPi * static_cast<double>(k);
      const auto exact = [&](double t) { return std::cos(harmonic * t - 0.4); };
      const std::vector<double> values = sampled(phases, exact);
      for (double t = 0; t < 1; t += 0.0173)
        ASSERT_NEAR(interpolated(weights, values, t), exact(t), 1e-12) << n << ' ' << k;
    }
  }
}

TEST(MotionInterpolationLaw, FourierIsExactForUnevenKeyframesToo) {
  const std::vector<double> phases{0.05, 0.2, 0.31, 0.5, 0.64, 0.81, 0.9};
  const KeyframeWeights weights(phases, Interpolation::fourier);
  const auto exact = [](double t) { return 1 + std::sin(kTwoPi * t) - std::cos(3 * kTwoPi * t); };
  const std::vector<double> values = sampled(phases, exact);
  for (double t = 0; t < 1; t += 0.0173)
    EXPECT_NEAR(interpolated(weights, values, t), exact(t), 1e-12);
}

TEST(MotionInterpolationLaw, EvenFourierSplitsTheHighestFrequency) {
  const std::vector<double> phases = evenPhases(8);
  const KeyframeWeights weights(phases, Interpolation::fourier);
  const std::vector<double> alternating{1, -1, 1, -1, 1, -1, 1, -1};
  for (double t = 0; t < 1; t += 0.0173)
    EXPECT_NEAR(interpolated(weights, alternating, t), std::cos(4 * kTwoPi * t), 1e-13);
}

// The periodic spline's second derivatives in long double by elimination with pivoting.
std::vector<long double> denseCurvatures(const std::vector<double>& t,
                                         const std::vector<double>& x) {
  const std::size_t n = t.size();
  std::vector<std::vector<long double>> a(n, std::vector<long double>(n + 1, 0));
  for (std::size_t j = 0; j < n; ++j) {
    const std::size_t i = (j + n - 1) % n, k = (j + 1) % n;
    const long double h0 = j > 0 ? static_cast<long double>(t[j]) - t[i] : t[0] + 1.0L - t[n - 1];
    const long double h1 = k > 0 ? static_cast<long double>(t[k]) - t[j] : t[0] + 1.0L - t[n - 1];
    a[j][i] += h0;
    a[j][j] += 2 * (h0 + h1);
    a[j][k] += h1;
    a[j][n] = 6 * ((x[k] - static_cast<long double>(x[j])) / h1 -
                   (x[j] - static_cast<long double>(x[i])) / h0);
  }
  for (std::size_t p = 0; p < n; ++p) {
    std::size_t best = p;
    for (std::size_t r = p; r < n; ++r)
      if (std::fabs(a[r][p]) > std::fabs(a[best][p])) best = r;
    std::swap(a[p], a[best]);
    for (std::size_t r = 0; r < n; ++r) {
      const long double factor = a[r][p] / a[p][p];
      for (std::size_t c = p; r != p && c <= n; ++c) a[r][c] -= factor * a[p][c];
    }
  }
  std::vector<long double> m;
  for (std::size_t j = 0; j < n; ++j) m.push_back(a[j][n] / a[j][j]);
  return m;
}

// The periodic spline solved in long double is the oracle.
TEST(MotionInterpolationLaw, SplineMatchesALongDoubleSolution) {
  for (const std::vector<double>& t : kPhaseSets) {
    const std::size_t n = t.size();
    const std::vector<double> x = sampled(t, [](double p) { return std::sin(20 * p) + p; });
    const std::vector<long double> m = denseCurvatures(t, x);
    const KeyframeWeights weights(t, Interpolation::spline);
    for (std::size_t j = 0; j < n; ++j) {
      const std::size_t k = (j + 1) % n;
      const long double h = k > 0 ? static_cast<long double>(t[k]) - t[j] : t[0] + 1.0L - t[n - 1];
      for (const long double b : {0.1L, 0.5L, 0.83L}) {
        const long double a = 1 - b;
        const long double exact =
            a * x[j] + b * x[k] + h * h / 6 * ((a * a * a - a) * m[j] + (b * b * b - b) * m[k]);
        const double phase = static_cast<double>(t[j] + b * h);
        EXPECT_NEAR(interpolated(weights, x, phase), static_cast<double>(exact), 1e-13);
      }
    }
  }
}

}  // namespace
}  // namespace echocine::motion_test
