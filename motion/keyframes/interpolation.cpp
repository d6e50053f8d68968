#include "motion/keyframes/interpolation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/check.h"

namespace echocine {

namespace {

constexpr double kMinGap = 1e-6;  // cycles; about 1 us, so no two real keyframes are this close
constexpr double kPi = std::numbers::pi;

void checkPhases(std::span<const double> phases, const SourcePlace& place) {
  const auto fail = [&](std::size_t k, const char* what) {
    throw SceneError(
        atPlace(place, fmt::format("keyframe {} has phase {}: {}", k + 1, phases[k], what)));
  };
  if (phases.empty()) throw SceneError(atPlace(place, "at least one keyframe is needed"));
  for (std::size_t k = 0; k < phases.size(); ++k) {
    if (!(phases[k] >= 0 && phases[k] < 1)) fail(k, "phases from 0 to below 1 are accepted");
    if (k > 0 && !(phases[k] - phases[k - 1] >= kMinGap))
      fail(k, "phases must ascend by at least 1e-6");
  }
  if (phases.size() > 1 && !(phases.front() + 1 - phases.back() >= kMinGap))
    fail(phases.size() - 1, "the first keyframe follows less than 1e-6 later");
}

const char* advice(Interpolation kind) {
  return kind == Interpolation::fourier
             ? "space them evenly or use motion.interpolation = \"spline\""
             : "space them evenly or use motion.interpolation = \"linear\"";
}

// Solves A X = B in place of B. A is symmetric and strictly diagonally dominant, so elimination
// needs no pivoting; the few hundred keyframes a cycle may have need no sparse solver.
void solveDense(std::vector<double>& a, std::vector<double>& b, std::size_t n) {
  for (std::size_t pivot = 0; pivot < n; ++pivot) {
    for (std::size_t row = 0; row < n; ++row) {
      const double factor = a[row * n + pivot] / a[pivot * n + pivot];
      if (row == pivot || factor == 0) continue;
      for (std::size_t k = pivot; k < n; ++k) a[row * n + k] -= factor * a[pivot * n + k];
      for (std::size_t k = 0; k < n; ++k) b[row * n + k] -= factor * b[pivot * n + k];
    }
  }
  for (std::size_t row = 0; row < n; ++row)
    for (std::size_t k = 0; k < n; ++k) b[row * n + k] /= a[row * n + row];
}

}  // namespace

KeyframeWeights::KeyframeWeights(std::span<const double> phases, Interpolation kind,
                                 const SourcePlace& place, const HeartPace& pace)
    : phases_(phases.begin(), phases.end()), kind_(kind), pace_(pace) {
  checkPhases(phases, place);
  if (phases_.size() == 1) return;
  if (kind == Interpolation::spline) prepareSpline();
  if (kind == Interpolation::fourier) prepareFourier();
  const double magnified = magnification();
  if (!(magnified <= kMaxMagnification))
    throw SceneError(atPlace(
        place,
        fmt::format("between keyframes spaced this unevenly it can magnify their differences "
                    "{:.3g} times, at most {:g} is accepted: {}",
                    magnified, kMaxMagnification, advice(kind))));
}

std::size_t KeyframeWeights::rowCount() const {
  return phases_.size() + (curvature_.empty() ? 0 : phases_.size());
}

std::span<const double> KeyframeWeights::rowWeights(std::size_t row) const {
  const std::size_t n = phases_.size();
  DCHECK_LE(n, row);
  return std::span(curvature_).subspan((row - n) * n, n);
}

double KeyframeWeights::gapAfter(std::size_t keyframe) const {
  const bool is_last = keyframe + 1 == phases_.size();
  return is_last ? phases_.front() + 1 - phases_.back() : phases_[keyframe + 1] - phases_[keyframe];
}

KeyframeWeights::Interval KeyframeWeights::intervalAt(double phase) const {
  const std::size_t n = phases_.size();
  const auto after = std::upper_bound(phases_.begin(), phases_.end(), phase);
  const bool is_before_first = after == phases_.begin();
  const std::size_t left =
      is_before_first ? n - 1 : static_cast<std::size_t>(after - phases_.begin()) - 1;
  const double length = gapAfter(left);
  const double elapsed = phase - phases_[left] + (is_before_first ? 1 : 0);
  return {left, (left + 1) % n, length, std::clamp(elapsed / length, 0.0, 1.0)};
}

std::pair<std::size_t, std::size_t> KeyframeWeights::around(double phase) const {
  const double wrapped = phase - std::floor(phase);
  const Interval at = intervalAt(wrapped < 1 ? wrapped : 0.0);
  if (at.fraction == 0) return {at.left, at.left};
  if (at.fraction == 1) return {at.right, at.right};
  return {at.left, at.right};
}

void KeyframeWeights::termsAt(double phase, std::vector<Term>& terms) const {
  terms.clear();
  const double wrapped = phase - std::floor(phase);  // may round up to 1, the same instant as 0
  const Interval at = intervalAt(wrapped < 1 ? wrapped : 0.0);
  if (at.fraction == 0 || phases_.size() == 1) {
    terms.push_back({at.left, 1.0});
  } else if (at.fraction == 1) {
    terms.push_back({at.right, 1.0});
  } else if (kind_ == Interpolation::fourier) {
    addFourier(wrapped, terms);
  } else if (kind_ == Interpolation::spline) {
    addSpline(at, terms);
  } else if (kind_ == Interpolation::catmull_rom) {
    addCatmullRom(at, terms);
  } else {
    const double share = kind_ == Interpolation::cycle ? shareOfWay(at) : at.fraction;
    terms.push_back({at.left, 1 - share});
    terms.push_back({at.right, share});
  }
}

// Progress of the heart from the left keyframe to the right one, in [0, 1]: no weight is negative,
// so no point leaves the line between its two keyframes.
double KeyframeWeights::shareOfWay(const Interval& at) const {
  const double from = phases_[at.left];
  const double begin = pace_.travelled(from), end = pace_.travelled(from + at.length);
  return (pace_.travelled(from + at.fraction * at.length) - begin) / (end - begin);
}

void KeyframeWeights::at(double phase, std::span<double> weights) const {
  CHECK_EQ(weights.size(), phases_.size());
  std::vector<Term> terms;
  termsAt(phase, terms);
  std::fill(weights.begin(), weights.end(), 0.0);
  for (const Term& term : terms) {
    if (term.row < phases_.size()) {
      weights[term.row] += term.weight;
      continue;
    }
    const std::span<const double> row = rowWeights(term.row);
    for (std::size_t k = 0; k < weights.size(); ++k) weights[k] += term.weight * row[k];
  }
}

// Cubic Hermite with the slope of the parabola through a keyframe and its two neighbours,
//   m_j = (h_j d_{j-1} + h_{j-1} d_j) / (h_{j-1} + h_j),  h_j = t_{j+1} - t_j,  d_j = (x_{j+1} -
//   x_j) / h_j,
// which for even spacing is Catmull and Rom's (x_{j+1} - x_{j-1}) / 2h.
void KeyframeWeights::addCatmullRom(const Interval& at, std::vector<Term>& terms) const {
  const std::size_t n = phases_.size();
  const std::size_t before = (at.left + n - 1) % n, after = (at.right + 1) % n;
  const double h_before = gapAfter(before), h = at.length, h_after = gapAfter(at.right);
  const double s = at.fraction, r = 1 - s;
  const double value_right = s * s * (3 - 2 * s), value_left = 1 - value_right;
  const double slope_left = h * s * r * r, slope_right = -h * s * s * r;
  // Slope at the left keyframe: parts of d_before and of d; at the right one: of d and of d_after.
  const double d_before = slope_left * h / (h_before + h) / h_before;
  const double d =
      (slope_left * h_before / (h_before + h) + slope_right * h_after / (h + h_after)) / h;
  const double d_after = slope_right * h / (h + h_after) / h_after;
  terms.push_back({before, -d_before});
  terms.push_back({at.left, value_left + d_before - d});
  terms.push_back({at.right, value_right + d - d_after});
  terms.push_back({after, d_after});
}

// Periodic cubic spline: on an interval of length h with a = 1 - fraction, b = fraction,
//   x = a x_j + b x_{j+1} + h^2/6 ((a^3 - a) x''_j + (b^3 - b) x''_{j+1}).
void KeyframeWeights::addSpline(const Interval& at, std::vector<Term>& terms) const {
  const std::size_t n = phases_.size();
  const double b = at.fraction, a = 1 - b;
  const double scale = -at.length * at.length * a * b / 6;  // a^3 - a = -a b (1 + a)
  terms.push_back({at.left, a});
  terms.push_back({at.right, b});
  terms.push_back({n + at.left, scale * (1 + a)});
  terms.push_back({n + at.right, scale * (1 + b)});
}

// Continuous first derivatives: h_{j-1} x''_{j-1} + 2 (h_{j-1} + h_j) x''_j + h_j x''_{j+1} =
// 6 (d_j - d_{j-1}), solved once for each keyframe's unit vector. Coefficients are added so that
// two keyframes, each the other's neighbour on both sides, are no special case.
void KeyframeWeights::prepareSpline() {
  const std::size_t n = phases_.size();
  std::vector<double> matrix(n * n, 0.0);
  curvature_.assign(n * n, 0.0);
  for (std::size_t j = 0; j < n; ++j) {
    const std::size_t before = (j + n - 1) % n, after = (j + 1) % n;
    const double h_before = gapAfter(before), h = gapAfter(j);
    matrix[j * n + before] += h_before;
    matrix[j * n + j] += 2 * (h_before + h);
    matrix[j * n + after] += h;
    curvature_[j * n + before] += 6 / h_before;
    curvature_[j * n + j] -= 6 / h_before + 6 / h;
    curvature_[j * n + after] += 6 / h;
  }
  solveDense(matrix, curvature_, n);
}

// Trigonometric interpolation in its barycentric form, Henrici, "Barycentric formulas for
// interpolating trigonometric polynomials and their conjugates", Numer. Math. 33 (1979): for an odd
// number of keyframes weight_j ~ w_j / sin(pi (t - t_j)), for an even one w_j cot(pi (t - t_j)),
// with w_j = 1 / prod_k sin(pi (t_j - t_k)), divided by their sum. The cotangent splits the highest
// frequency evenly between sine and cosine when keyframes are evenly spaced.
void KeyframeWeights::addFourier(double phase, std::vector<Term>& terms) const {
  double sum = 0;
  for (std::size_t j = 0; j < phases_.size(); ++j) {
    const double angle = kPi * (phase - phases_[j]);
    double weight = barycentric_[j] / std::sin(angle);
    if (phases_.size() % 2 == 0) weight *= std::cos(angle);
    terms.push_back({j, weight});
    sum += weight;
  }
  for (Term& term : terms) term.weight /= sum;
}

void KeyframeWeights::prepareFourier() {
  const std::size_t n = phases_.size();
  std::vector<double> log_magnitude(n, 0.0);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t k = 0; k < n; ++k)
      if (k != j)
        log_magnitude[j] -= std::log(std::fabs(std::sin(kPi * (phases_[j] - phases_[k]))));
  const double largest = *std::max_element(log_magnitude.begin(), log_magnitude.end());
  // Phases ascend, so the factors sin(pi (t_j - t_k)) with k > j are the negative ones.
  for (std::size_t j = 0; j < n; ++j)
    barycentric_.push_back(((n - 1 - j) % 2 == 0 ? 1 : -1) * std::exp(log_magnitude[j] - largest));
}

double KeyframeWeights::magnification() const {
  constexpr int kSamples = 16;  // per interval
  std::vector<double> weights(phases_.size());
  double largest = 1;
  for (std::size_t j = 0; j < phases_.size(); ++j) {
    for (int s = 1; s < kSamples; ++s) {
      at(phases_[j] + gapAfter(j) * s / kSamples, weights);
      double sum = 0;
      for (const double weight : weights) sum += std::fabs(weight);
      if (!(sum <= largest)) largest = sum;  // also propagates NaN
    }
  }
  return largest;
}

double KeyframeWeights::overshoot() const {
  constexpr double kSlack = 1.01;  // the magnification is estimated from samples
  return phases_.size() < 2 ? 0 : std::max(kSlack * magnification() - 1, 0.0) / 2;
}

}  // namespace echocine
