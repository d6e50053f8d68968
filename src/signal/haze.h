#pragma once
// Echoes that are received where they do not belong: beside them through side lobes, and behind
// them by reverberation. Both are added before speckle, so they are as speckled as tissue.

#include <span>

#include "scene/scene.h"

namespace echocine {

// Across the lines: adds level sum_j I_j a^|i - j| (1 - a)/(1 + a) to line i, the line itself
// included, with a = exp(-pitch / width): a two-sided exponential whose weights sum to 1 over
// endless lines. Beyond the sector's edges nothing echoes.
class SideLobeHaze {
 public:
  SideLobeHaze(const Probe& probe, double level_db, double width_rad);
  void add(std::span<float> plane) const;

 private:
  int lines_, samples_;
  float decay_, level_;
};

// Along the line: adds level sum_{m > 0} I_(k-m) a^m (1 - a)/a with a = exp(-spacing / length): a
// one-sided exponential whose weights sum to 1. Measured in hearts with a mean of about 5 mm
// (Byram, J. Acoust. Soc. Am. 140, 2016).
class ReverberationTail {
 public:
  ReverberationTail(const Probe& probe, double level_db, double length_m);
  void add(std::span<float> plane) const;  // of whole lines

 private:
  int samples_;
  float decay_, level_;
};

}  // namespace echocine
