#pragma once
// The end of a descent: regressions through many places about the best one.

#include "fit/fit_descent.h"

namespace echocine::fit {

// Rounds to a minimum, and to tell which of several minima is the lower. Our choice.
inline constexpr std::size_t kPolishRounds = 6, kFirstPolishRounds = 3;
// Pairs of places in a round, a third more places than a quadratic of a view's unknowns has
// coefficients: 24 of 7 unknowns.
constexpr std::size_t polishPairs(std::size_t unknowns) {
  const std::size_t coefficients = 1 + unknowns + unknowns * (unknowns + 1) / 2;
  return (2 * coefficients + 2) / 3;
}

// Each round evaluates J at pairs of places, c + x and c - x, about the best place c. x is drawn
// from the normal distribution of the covariance of J's curvature, s times as wide, where s falls
// from 2.5 to 1.5. A quadratic of each view is fitted to all places by Eq. 22, with weights
// exp(-d^2 / (2 n s^2)); d is the distance from c in standard deviations, n the number of unknowns
// that are not held.
// The round ends at the minimum of the sum, or at a drawn place that is clearly lower. These
// numbers are our choice. J is rough: descents by differences ended up to 57 above the lowest J of
// a planted heart that was found. Draws are hashes of round, pair and unknown. Without a
// covariance nothing is done. Stops without an error when the monitor requests it.
FitDescent polishFit(const FitCost& cost, FitDescent from, const Monitor& monitor,
                     std::size_t rounds = kPolishRounds);

}  // namespace echocine::fit
