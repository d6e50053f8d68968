#pragma once
// Loops that cannot be fitted, and what is odd about loops that can.

#include <optional>
#include <string>
#include <vector>

#include "fit/heart_fit.h"

namespace echocine::fit {

// Variance over time, as a part of the variance over the picture, below which a loop is a still.
// Our choice: loops of hearts have 0.05 or more, compressed stills less than 1e-4.
inline constexpr double kLeastMotion = 1e-3;

// Mean over the sector's pixels of the variance of a pixel over time, divided by the variance of
// the mean picture; 0 for a sector without pixels.
double motionOf(const echo::EchoLoop& loop);

// Throws SceneError for a loop whose pictures do not change.
void checkMoves(const FitLoop& one);

// One line for each anomaly that reading a loop noted, such as colour over its sector, with its
// view.
std::vector<std::string> notesOf(const FitLoop& one);

// Heart rate, per minute: the mean over loops that have one, within the models' range. Adds a hint
// if rates differ by more than 15 %.
std::optional<double> rateOf(const std::vector<FitLoop>& loops, std::vector<std::string>& hints);

// By loop, the persistence of Eq. 26; none if it is not known.
std::vector<std::optional<double>> persistencesOf(const std::vector<FitLoop>& loops);

// HeartFitOptions::own_look, with the default for loops of this persistence.
bool ownLookFor(const std::vector<std::optional<double>>& persistence,
                const HeartFitOptions& options);

// Least agreement with own loops of a fit that expects their look: kLeastAgreement, or 0 where the
// look was asked for, or where persistence biases plain fits.
double leastAgreement(const std::vector<std::optional<double>>& persistence,
                      const HeartFitOptions& options);

}  // namespace echocine::fit
