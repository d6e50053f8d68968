#pragma once
// R waves in an ECG trace.

#include <span>
#include <vector>

namespace echocine::echo {

struct RWaves {
  std::vector<double> at;  // samples
  // 0..1: margin between the R waves and the sharpest other deflection; 0 if they are not narrow,
  // not tall, or not regular.
  double confidence = 0;
};

// Deflections to one side whose ratio of prominence to width at half prominence is at least 0.4 of
// the sharpest one's: narrow and tall. The side with the sharper deflections is used. NaN: unknown.
// `thickness`: of the curve, in units of the heights; smaller waves are ignored.
RWaves findRWaves(std::span<const double> heights, double thickness);

}  // namespace echocine::echo
