#pragma once
// The pose of lowest discrepancy of a model's plane in a real one.

#include <vector>

#include "fit/fit_terms.h"

namespace echocine::fit {

// Limits of a pose, for hearts of other people and other probe positions. Our choice. The scale is
// fixed if both scales are known.
struct PoseLimits {
  double shift = 0.2;    // of the model's depth, each way
  double turn_deg = 25;  // each way
  double scale = 0.15;   // each way, if it is free
  bool scale_free = false;
};

struct PoseFound {
  FitPose pose;
  FitTerms terms;
  double discrepancy = 1;
  // Other optima in ascending order, more than 10 mm or 10 degrees from the best.
  std::vector<std::pair<FitPose, double>> rivals;
  // Eq. 8 of descent.h; the baseline is the median of all starts.
  double confidence = 0;
  bool at_limit = false;
};

// One method for all loops: all poses of a lattice (7.5 mm in 15 cm, 10 degrees, 7 % of scale) over
// a few frames, then Newton's method with finite differences from the best five. The best result is
// evaluated with all frames. Positions are continuous. Runs in parallel; the result does not depend
// on the threads.
// `also`: further starts. If one of them leads to a lower discrepancy, the optima of the search are
// its rivals.
PoseFound searchPose(const ModelLoop& model, const echo::EchoStack& real, const FitWeights& weights,
                     const PoseLimits& limits, const std::vector<FitPose>& also = {});

// Starts only from given poses, moved into the limits, for a model close to one of known pose.
// Precondition: all have the same time, lag and systole.
PoseFound refinePose(const ModelLoop& model, const echo::EchoStack& real, const FitWeights& weights,
                     const PoseLimits& limits, const std::vector<FitPose>& starts);

}  // namespace echocine::fit
