#pragma once
// Edge enhancement of a scanner: unsharp masking of grey levels before scan conversion.

#include <span>
#include <vector>

#include "scene/scene.h"

namespace echocine {

// g' = g + e (g - m), limited to 0..1: m is the mean of g over a box of the stated size, along the
// line and, at the probe's middle depth, across the lines. At the borders of the plane the box
// ends. A constant plane stays as it is; a step s gains e s / 2 on either side.
class EdgeEnhancement {
 public:
  EdgeEnhancement(const Probe& probe, const SignalSettings& settings);

  void apply(std::span<float> greys) const;      // line-major; runs in parallel
  int halfLines() const { return half_lines_; }  // on either side, that a line depends on

 private:
  int lines_, samples_, half_lines_, half_samples_;
  float amount_;
};

}  // namespace echocine
