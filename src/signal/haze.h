#pragma once
// Misplaced echoes: lateral ones from aberration and multiple scattering, deeper ones from
// reverberation. Both are added before speckle, so they are speckled like tissue.

#include <span>

#include "scene/scene.h"

namespace echocine {

// Across the lines: adds level sum_j I_j a^|i - j| (1 - a)/(1 + a) to line i, itself included, with
// a = exp(-pitch / width): a two-sided exponential whose weights sum to 1 over infinitely many
// lines. There are no echoes beyond the sector's edges; a full turn goes on across its seam.
class LateralHaze {
 public:
  LateralHaze(const Probe& probe, double level_db, double width_rad);
  void add(std::span<float> plane) const;

 private:
  int lines_, samples_;
  bool full_turn_;
  float decay_, level_;
};

// Along the line: adds level sum_{m > 0} I_(k-m) a^m (1 - a)/a with a = exp(-spacing / length): a
// one-sided exponential whose weights sum to 1. Measured in hearts with a mean length of about 5 mm
// (Byram, J. Acoust. Soc. Am. 140, 2016).
class ReverberationTail {
 public:
  ReverberationTail(const Probe& probe, double level_db, double length_m);
  void add(std::span<float> plane) const;  // whole lines

 private:
  int samples_;
  float decay_, level_;
};

}  // namespace echocine
