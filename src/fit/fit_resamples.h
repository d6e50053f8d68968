#pragma once
// The spread of a fit's dials over parts of the loops.

#include <memory>
#include <vector>

#include "fit/fit_descent.h"

namespace echocine::fit {

inline constexpr int kLeastResamples = 4, kMostResamples = 10;

// Throws SceneError unless it is 0 or kLeastResamples to kMostResamples.
void checkResamples(int blocks);

// (19)  SD_J^2 = (g - 1)/g sum_i (x_i - x)^2
// The block jackknife (Kuensch, Annals of Statistics 17, 1989): the beat has g blocks of successive
// pictures, x_i is the value without block i, x the mean of all x_i.
double jackknifeSd(const std::vector<double>& values);

// Descends from the best place once without each of `blocks` blocks of the pictures of every loop.
// SD_J by dial; empty if the monitor stopped it. Precondition: checkResamples() and blocks > 0.
std::vector<double> resampledSds(const std::vector<FitSide>& sides, const FitCost& cost,
                                 const FitPlace& best, int blocks,
                                 const std::shared_ptr<FitJournal>& journal,
                                 const Monitor& monitor);

// A covariance of the unknowns whose SD of each dial is no smaller than SD_J; correlations stay.
void widenBy(const std::vector<double>& sds, std::vector<double>& covariance);

}  // namespace echocine::fit
