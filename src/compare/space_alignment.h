#pragma once
// What is left between two loops in space once their sectors lie on one another: found from the
// echoes themselves.

#include <string>
#include <vector>

#include "compare/beam_grid.h"

namespace echocine::compare {

// Greys that correlate less hardly resemble one another, and their best fit says nothing; our
// choice.
inline constexpr double kAlikeCorrelation = 0.5;

struct SpaceAlignment {
  Placement placement;                         // of beam space in the real picture
  std::string method = "sectors as they are";  // or "Lucas and Kanade", "search for the view"
  // Of greys; of edges, times the share in sight, where the view was searched for.
  double correlation_before = 0, correlation_after = 0;
  bool used = false;      // false: no gain, or hardly alike; the sectors stand as they are
  bool at_limit = false;  // of what the search may do: the best may lie beyond
  double confidence = 0;  // the correlation it reaches, 0..1
};

// Shift, scale and rotation (about the apex) that let the synthetic frames, at any brightness and
// contrast, explain the real ones best: Gauss-Newton on the squared grey differences from coarse to
// fine, as Lucas and Kanade (IJCAI 1981). `paired[i]` is the synthetic frame of real frame
// `real_frames[i]`. Limits (our choice), from `start`: 6 % of the radius, 6 % of scale, 6 degrees.
// Used where greys correlate above kAlikeCorrelation.
SpaceAlignment alignInSpace(const BeamGrid& grid, const Loop& real,
                            const std::vector<std::vector<float>>& paired,
                            const std::vector<int>& real_frames, const std::vector<float>& weights,
                            const Placement& start = {});

}  // namespace echocine::compare
