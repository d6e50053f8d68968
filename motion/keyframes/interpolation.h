#pragma once
// Periodic interpolation in time. Every kind is linear in the keyframes, so it is one weight per
// keyframe that holds for all coordinates of all vertices.

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "core/error.h"
#include "motion/cycle/heart_pace.h"
#include "scene/scene.h"

namespace echocine {

// Largest accepted sum of absolute weights at any phase: an upper bound for the amplification of
// errors in the keyframes. With even spacing it is below 3 for every kind up to 100 keyframes.
// Uneven spacing can exceed any bound, first for trigonometric polynomials. Our choice.
inline constexpr double kMaxMagnification = 10;

class KeyframeWeights {
 public:
  // x(phase) = sum of weight * row, where row r < keyframeCount() is keyframe r itself and row
  // keyframeCount() + j is sum over k of rowWeights()[k] * keyframe k.
  struct Term {
    std::size_t row;
    double weight;
  };

  // Phases in cycles. Throws SceneError that starts with the place unless they ascend within [0,
  // 1), at least 1e-6 apart (also cyclically), and the interpolation stays below kMaxMagnification.
  // `pace` is the heart's pace for Interpolation::cycle.
  KeyframeWeights(std::span<const double> phases, Interpolation kind, const SourcePlace& place = {},
                  const HeartPace& pace = {});

  std::size_t keyframeCount() const { return phases_.size(); }
  std::span<const double> phases() const { return phases_; }
  const HeartPace& pace() const { return pace_; }

  // The keyframes before and after a phase; at a keyframe both are that keyframe.
  std::pair<std::size_t, std::size_t> around(double phase) const;
  std::size_t rowCount() const;
  std::span<const double> rowWeights(std::size_t row) const;  // row >= keyframeCount()

  // The shortest form of the sum: at most four terms for all kinds except fourier, exactly one at a
  // keyframe. The phase may be any finite number. Does not allocate if `terms` has the capacity.
  void termsAt(double phase, std::vector<Term>& terms) const;

  // One weight per keyframe; they sum to 1. Precondition: weights.size() == keyframeCount().
  void at(double phase, std::span<double> weights) const;

  // Largest sum of absolute weights over a cycle (the Lebesgue constant), from 16 samples per
  // interval.
  double magnification() const;

  // Largest excursion of a point beyond the range of its keyframes, relative to that range: with
  // weights w that sum to 1, sum w p = c + sum w (p - c) stays within sum |w| times half the range
  // around its centre c.
  double overshoot() const;

 private:
  struct Interval {
    std::size_t left, right;  // keyframes
    double length, fraction;  // length in cycles; fraction of it, [0, 1)
  };
  Interval intervalAt(double phase) const;
  double gapAfter(std::size_t keyframe) const;
  double shareOfWay(const Interval& at) const;
  void addCatmullRom(const Interval& at, std::vector<Term>& terms) const;
  void addSpline(const Interval& at, std::vector<Term>& terms) const;
  void addFourier(double phase, std::vector<Term>& terms) const;
  void prepareSpline();
  void prepareFourier();

  std::vector<double> phases_;
  Interpolation kind_;
  HeartPace pace_;
  std::vector<double>
      curvature_;  // spline: second derivatives at keyframes, row-major from keyframes
  std::vector<double> barycentric_;  // fourier: weight of each keyframe, largest magnitude 1
};

}  // namespace echocine
