#pragma once
// Noise of the receiver and clutter of the near field: random intensities with the grain that the
// scanner's own filters give them, whatever the tissue does.

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace echocine {

// Filtered complex Gaussian noise, squared: a plane of intensities with mean 1 that repeats in both
// directions. Its amplitude is white noise through bells of these deviations; smoothing (of the
// intensity, along the line) is the speckle's.
struct Grain {
  double lateral_lines = 0, axial_samples = 0, smoothing_samples = 0;  // standard deviations
};
class RandomPlane {
 public:
  RandomPlane(int lines, int samples, const Grain& grain, std::uint64_t seed);
  int lines() const { return lines_; }
  int samples() const { return samples_; }
  const float* line(int i) const {
    return values_.data() + static_cast<std::ptrdiff_t>(i) * samples_;
  }

 private:
  int lines_, samples_;
  std::vector<float> values_;
};

// The grain of speckle at a depth, which an echo of noise shares: of a scene's probe and pulse.
// width_rad above 0 widens it across the lines: its full width at half maximum, in intensity.
Grain grainOf(const Scene& scene, double width_rad = 0);

// White noise before the time gain, after it: intensity level gain_k / max(gain) at sample k, on
// average. Every instant draws a part of one random plane by a hash of seed and time. No gains:
// alike at all depths.
class ReceiverNoise {
 public:
  ReceiverNoise(const Scene& scene, std::span<const float> gains);
  void add(double white, double time_s, std::span<float> plane) const;

 private:
  int lines_, samples_, seed_;
  std::vector<float> levels_;  // over white, by sample
  RandomPlane random_;
};

// Reverberation between face and chest wall: level exp(-r / length) at the path length r, on
// average; it stands still while the heart beats. Deeper than 60 dB below its level there is none.
class NearFieldClutter {
 public:
  explicit NearFieldClutter(const Scene& scene);
  void add(double white, std::span<float> plane) const;

 private:
  int lines_, samples_;
  std::vector<float> levels_;  // over white, by sample, as deep as it reaches
  RandomPlane random_;
};

}  // namespace echocine
