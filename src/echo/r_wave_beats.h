#pragma once
// The length of a beat from R waves. Some may be missing.

#include <vector>

namespace echocine::echo {

// Beats in an interval between R waves: 1, unless the interval is within a quarter of a beat of two
// or more. So an early beat and the pause after it are one beat each. `beat`: its usual length.
int beatsBetween(double interval, double beat);

// Mean and median length of a beat, in the unit of the waves.
struct RWaveBeat {
  double mean = 0, median = 0;  // 0: fewer than two waves
};

// R waves give the exact times. The beat that the pictures show (`seen`; 0: unknown) tells how many
// beats lie between two waves: the usual interval is divided if it is two or three of these.
// Precondition: waves ascend.
RWaveBeat beatOfRWaves(const std::vector<double>& waves, double seen);

}  // namespace echocine::echo
