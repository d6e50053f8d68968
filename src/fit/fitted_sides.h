#pragma once
// Families and comparisons of all views of a fit, and what the found heart shows against itself.

#include <deque>
#include <memory>
#include <vector>

#include "fit/fit_descent.h"
#include "fit/heart_fit.h"

namespace echocine::fit {

struct FittedSides {
  std::vector<std::shared_ptr<const HeartFamily>> families;
  std::deque<ModelDiscrepancy> discrepancies;

  FittedSides() = default;
  FittedSides(const std::vector<FitLoop>& loops, const HeartNodes& hearts, double tilt_deg,
              const Monitor& monitor);
  // With models of these dials, which find the beat. Costs of the earlier ones are invalid then. If
  // it throws, nothing has changed.
  void compare(const std::vector<FitLoop>& loops, const std::vector<double>& dials);
  std::vector<FitSide> refer() const;
};

inline constexpr int kOwnDraws = 2;  // of speckle; our choice
// Our choice, with one planted heart in one and in three views: the whole error overshot there.
inline constexpr double kOwnShare = 0.5;

// The best heart against its own rendered loops.
struct OwnFit {
  // By dial: where these loops move the heart from its known place.
  std::vector<double> error;
  std::vector<FitReport> report;  // by view, in the first draw
};

// (18)  error = -C mean over draws of g_own / 2
// C: the covariance of the descent; g_own: the gradient of J without the prior at the rendered
// heart, which would be 0 without an error of the comparison. At most two steps of each unknown.
// None if the monitor stopped it. Throws SceneError for an impossible heart. Runs in parallel.
// Precondition: the descent has a covariance.
std::optional<OwnFit> fitOwnLoops(const FittedSides& sides, const FitCost& cost,
                                  const std::vector<heart::View>& views, const FitDescent& best,
                                  double tilt_deg, const Monitor& monitor);

// Moves the dials of a place towards the middle of their ranges by a quarter of the distance until
// a heart has them. False if nothing was moved.
bool makePossible(const FitCost& cost, std::vector<double>& at);

}  // namespace echocine::fit
