#pragma once
// Receiver noise and near-field clutter: random intensities with the grain of the scanner's
// filters, independent of the tissue.

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace echocine {

// Filtered complex Gaussian noise, squared: a plane of intensities with mean 1, periodic in both
// directions. Its amplitude is white noise filtered by Gaussians of these deviations; smoothing (of
// the intensity, along the line) is that of the speckle.
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

// The grain of speckle at a depth, which noise shares, for a scene's probe and pulse. width_rad > 0
// widens it across the lines: full width at half maximum, in intensity.
Grain grainOf(const Scene& scene, double width_rad = 0);

// Noise that is white before the time gain; after it the mean intensity is level gain_k / max(gain)
// at sample k. Each instant draws a part of one random plane by a hash of seed and time. Without
// gains it is uniform in depth.
class ReceiverNoise {
 public:
  ReceiverNoise(const Scene& scene, std::span<const float> gains);
  void add(double white, double time_s, std::span<float> plane) const;

 private:
  int lines_, samples_, seed_;
  std::vector<float> levels_;  // relative to white, by sample
  RandomPlane random_;
};

// Reverberation between face and chest wall: mean level exp(-r / length) at the path length r,
// static while the heart beats. It ends 60 dB below its level.
class NearFieldClutter {
 public:
  explicit NearFieldClutter(const Scene& scene);
  void add(double white, std::span<float> plane) const;

 private:
  int lines_, samples_;
  std::vector<float> levels_;  // relative to white, by sample, down to its end
  RandomPlane random_;
};

}  // namespace echocine
