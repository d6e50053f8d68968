#pragma once
// The instant of the synthetic loop that each real frame shows.

#include <optional>
#include <string>
#include <vector>

#include "echo/motion_features.h"

namespace echocine::compare {

struct TimeProblem {
  const echo::Features& synthetic;
  const echo::Features& real;
  double synthetic_beat = 0, real_beat = 0;  // frames; 0: unknown
  double nominal_rate = 1;                   // synthetic frames per real frame if beats are unknown
  std::vector<int> repeats;                  // real frames that repeat another
};

struct TimeAlignment {
  // Per real frame: the place in the synthetic loop, in frames, from 0 to the beat (periodic) or to
  // the last frame. Negative: outside a synthetic loop that is not a whole beat.
  std::vector<double> place;
  double shift_frames = 0;         // place of real frame 0 on the linear map
  double rate = 1;                 // synthetic frames per real frame on the linear map
  double largest_warp_frames = 0;  // largest deviation of the warp from the linear map
  double correlation = 0;          // mean over frames of the correlation of moving parts
  double confidence = 0;           // 0..1: distinctness of the best shift
  std::string method;              // "found by dynamic time warping", "ED and ES frames", "R waves"
  bool periodic = false;
};

// The linear map of highest mean correlation (shift, and rate unless both beats are known), then a
// time warp around it: dynamic programming over monotone offsets of an eighth of a frame, with a
// cost for changes of pace.
TimeAlignment alignInTime(const TimeProblem& problem);

// Piecewise linear between anchors (real frame -> synthetic place), which must rise, and periodic
// in the beat. Precondition: at least one anchor.
struct Anchor {
  double real = 0, synthetic = 0;  // frames
};
TimeAlignment alignByAnchors(const TimeProblem& problem, std::vector<Anchor> anchors);

}  // namespace echocine::compare
