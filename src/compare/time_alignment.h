#pragma once
// Which instant of the synthetic loop each real frame shows.

#include <optional>
#include <string>
#include <vector>

#include "echo/motion_features.h"

namespace echocine::compare {

struct TimeProblem {
  const echo::Features& synthetic;
  const echo::Features& real;
  double synthetic_beat = 0, real_beat = 0;  // frames; 0: not known
  double nominal_rate = 1;   // synthetic frames per real frame when beats are not known
  std::vector<int> repeats;  // real frames that say nothing of their own
};

struct TimeAlignment {
  // Per real frame: the place in the synthetic loop, in frames, 0 up to the beat (periodic) or to
  // the last frame; negative: outside a synthetic loop that is no whole beat.
  std::vector<double> place;
  double shift_frames = 0;         // place of real frame 0 on the straight map
  double rate = 1;                 // synthetic frames per real frame on the straight map
  double largest_warp_frames = 0;  // how far warping leads from the straight map
  double correlation = 0;          // mean over frames of the correlation of what moves
  double confidence = 0;           // 0..1: how far the best shift stands out from the rest
  std::string method;              // "found by dynamic time warping", "ED and ES frames", "R waves"
  bool periodic = false;
};

// The straight map (shift, and rate unless both beats are known) of highest mean correlation, then
// a time warp about it: dynamic programming over offsets of an eighth of a frame, which must not
// run backwards, at a cost for every change of pace.
TimeAlignment alignInTime(const TimeProblem& problem);

// Straight between anchors (real frame -> synthetic place), which must rise; one beat further the
// same again. Precondition: at least one anchor.
struct Anchor {
  double real = 0, synthetic = 0;  // frames
};
TimeAlignment alignByAnchors(const TimeProblem& problem, std::vector<Anchor> anchors);

}  // namespace echocine::compare
