#pragma once
// The one reference of a loop's log compression, from all of its frames: never a frame's own
// maximum, so a loop does not flicker.

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace echocine {

// Counts intensities of all frames in bins of 0.1 % and finds a percentile. Samples of the near
// field, the first 15 % of the depth, are left out, and so are samples without any intensity
// (behind total reflection, in media that scatter nothing). Counts are whole numbers, so the order
// of frames and threads has no effect.
class IntensityHistogram {
 public:
  explicit IntensityHistogram(const Probe& probe);

  void add(std::span<const float> plane);  // line-major; thread-safe
  // The samples in these media alone; `medium` is the plane's, by sample.
  void add(std::span<const float> plane, std::span<const std::uint32_t> medium,
           std::span<const char> counted);

  std::uint64_t positive() const;  // samples that were counted, of some intensity

  // The smallest bin edge that `percent` of the positive samples do not exceed; 1 without any.
  double percentile(double percent) const;

 private:
  template <typename Counts>
  void count(std::span<const float> plane, const Counts& counts);

  int samples_, first_sample_;
  std::unique_ptr<std::atomic<std::uint64_t>[]> counts_;
};

// White of a loop, from its frames: so far over the median of the heart's muscle that this has the
// grey of kMuscleGrey (scene/white_rule.h), where the scene leaves white to it and at least
// kLeastMuscle of the samples are muscle's; else the percentile of all samples.
class WhiteMeasure {
 public:
  // Keeps the reference.
  explicit WhiteMeasure(const Scene& scene);

  // `medium` is read where isWhiteByMuscle(scene). Line-major; thread-safe.
  void add(std::span<const float> intensities, std::span<const std::uint32_t> medium);
  double white() const;

  // Our choice: less is a wall at the sector's edge, not a view of the heart.
  static constexpr double kLeastMuscle = 0.01;

 private:
  const Scene& scene_;
  std::vector<char> muscle_media_;  // empty: white is not theirs
  IntensityHistogram all_, muscle_;
};

}  // namespace echocine
