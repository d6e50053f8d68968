#pragma once
// The one reference of a loop's log compression, from all of its frames: never a frame's own
// maximum, so a loop does not flicker.

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>

#include "scene/probe.h"

namespace echocine {

// Counts intensities of all frames in bins of 0.1 % and finds a percentile. Samples of the near
// field, the first 15 % of the depth, are left out, and so are samples without any intensity
// (behind total reflection, in media that scatter nothing). Counts are whole numbers, so the order
// of frames and threads has no effect.
class IntensityHistogram {
 public:
  explicit IntensityHistogram(const Probe& probe);

  void add(std::span<const float> plane);  // line-major; thread-safe

  // The smallest bin edge that `percent` of the positive samples do not exceed; 1 without any.
  double percentile(double percent) const;

 private:
  int samples_, first_sample_;
  std::unique_ptr<std::atomic<std::uint64_t>[]> counts_;
};

}  // namespace echocine
