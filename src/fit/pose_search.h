#pragma once
// Where a model's plane lies in a real one: the pose of least discrepancy.

#include <vector>

#include "fit/fit_terms.h"

namespace echocine::fit {

// How far a pose may go from none: hearts of other people, probes held otherwise. Our choice. The
// scale stays where both scales are known.
struct PoseLimits {
  double shift = 0.2;    // of the model's depth, each way
  double turn_deg = 25;  // each way
  double scale = 0.15;   // each way, where it is free
  bool scale_free = false;
};

struct PoseFound {
  FitPose pose;
  FitTerms terms;
  double discrepancy = 1;
  // Other optima, least first: farther than 10 mm or 10 degrees from the best.
  std::vector<std::pair<FitPose, double>> rivals;
  // Eq. 8 of descent.h; what says nothing is the median of all starts.
  double confidence = 0;
  bool at_limit = false;
};

// One method, whatever the loops are like: all poses of a lattice (7.5 mm in 15 cm, 10 degrees, 7 %
// of scale) over few frames, then Newton's method with finite differences from the best five,
// of which the best is taken and measured with all frames. Positions are continuous throughout.
// Runs in parallel. The same input gives the same pose whatever the threads.
PoseFound searchPose(const ModelLoop& model, const echo::EchoStack& real, const FitWeights& weights,
                     const PoseLimits& limits);

// From given starts alone: for a model that is hardly another than one whose pose is known.
PoseFound refinePose(const ModelLoop& model, const echo::EchoStack& real, const FitWeights& weights,
                     const PoseLimits& limits, const std::vector<FitPose>& starts);

}  // namespace echocine::fit
