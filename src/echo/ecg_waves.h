#pragma once
// R waves in an ECG trace.

#include <span>
#include <vector>

namespace echocine::echo {

struct RWaves {
  std::vector<double> at;  // samples
  // 0..1: how far the sharpest deflection that is no R wave falls behind the R waves; 0 where they
  // are not narrow, not tall, or not regular.
  double confidence = 0;
};

// Deflections to one side whose prominence over their width at half of it is 0.4 and more of the
// sharpest one's: narrow and tall. That side is taken on which they are sharper. NaN: not known.
// `thickness`: of the curve, in units of the heights: lower waves say nothing.
RWaves findRWaves(std::span<const double> heights, double thickness);

}  // namespace echocine::echo
