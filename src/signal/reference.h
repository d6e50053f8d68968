#pragma once
// The single reference of a loop's log compression, from all of its frames. A frame's own maximum
// would make the loop flicker.

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace echocine {

// Histogram of the intensities of all frames, in bins of 0.1 %, for percentiles. Samples of the
// near field, the first 15 % of the depth, are omitted, and so are samples of intensity 0 (behind
// total reflection, or without scattering). Counts are integers, so the order of frames and threads
// has no effect.
class IntensityHistogram {
 public:
  explicit IntensityHistogram(const Probe& probe);

  void add(std::span<const float> plane);  // line-major; thread-safe
  // Samples in these media only; `medium` is that of each sample of the plane.
  void add(std::span<const float> plane, std::span<const std::uint32_t> medium,
           std::span<const char> counted);

  std::uint64_t positive() const;  // number of counted samples of positive intensity

  // The smallest bin edge that `percent` of the positive samples do not exceed; 1 without samples.
  double percentile(double percent) const;

 private:
  template <typename Counts>
  void count(std::span<const float> plane, const Counts& counts);

  int samples_, first_sample_;
  std::unique_ptr<std::atomic<std::uint64_t>[]> counts_;
};

// White of a loop, from its frames. If the scene leaves white to the heart's muscle and at least
// kLeastMuscle of the samples are muscle, it is such that their median gets the grey level
// kMuscleGrey (scene/white_rule.h). Otherwise it is the percentile of all samples.
class WhiteMeasure {
 public:
  // Keeps the reference.
  explicit WhiteMeasure(const Scene& scene);

  // `medium` is used if isWhiteByMuscle(scene). Line-major; thread-safe.
  void add(std::span<const float> intensities, std::span<const std::uint32_t> medium);
  double white() const;

  // Our choice: a smaller share is a wall at the sector's edge, not a view of the heart.
  static constexpr double kLeastMuscle = 0.01;

 private:
  const Scene& scene_;
  std::vector<char> muscle_media_;  // empty: white does not follow the muscle
  IntensityHistogram all_, muscle_;
};

}  // namespace echocine
