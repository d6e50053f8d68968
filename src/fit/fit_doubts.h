#pragma once
// Why a fit's result is refused or uncertain, and what would help.

#include "fit/heart_fit.h"

namespace echocine::fit {

// J by which another fit must be worse to count as different: one a twentieth as likely still
// counts.
inline constexpr double kRival = 3;
// D above which a model explains hardly more than none. Our choice.
inline constexpr double kMostD = 0.9;
// Least share of the heart in the picture without a hint. Our choice.
inline constexpr double kLeastInSight = 0.6;

// Persistence (Eq. 26) from which on a hint mentions it, own loops have it, and a single loop is
// fitted with own look. Our choice.
inline constexpr double kMuchPersistence = 0.4;

// One line with the reason and what would help; empty if the loops determine the ejection fraction.
// Refused are: a view with D above kMostD; a view whose mirror image or shuffled pictures the heart
// fits as well as the loop itself, to kRival; an ejection fraction no narrower than its prior.
std::string refusalOf(const HeartFit& fit);

// Adds one line for each: a dial at its limit, or no narrower than its prior; by view an unknown
// length or an ambiguous start of the beat, another view that fits better, less than kLeastInSight
// of the heart in the picture, kMuchPersistence or more, a pose at its limit; no length scale; a
// rival within kRival whose ejection fraction is outside the interval. Precondition: intervals are
// not yet widened by rivals.
void addHints(HeartFit& fit);

}  // namespace echocine::fit
