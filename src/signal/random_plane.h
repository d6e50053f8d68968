#pragma once
// A plane of complex Gaussian numbers with the grain of the scanner's filters.

#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "speckle/point_spread.h"

namespace echocine {

// Standard deviations of the Gaussians that filter the amplitude.
struct Grain {
  double lateral_lines = 0, axial_samples = 0;
};

// Lines and samples from the first number of a plane on.
struct PlaneShift {
  int lines = 0, samples = 0;
};

// White noise filtered by the grain, with mean power 1; periodic in both directions.
class RandomPlane {
 public:
  RandomPlane(int lines, int samples, const Grain& grain, std::uint64_t seed);
  int lines() const { return lines_; }
  int samples() const { return samples_; }
  // Expected correlation of the plane with itself between two shifts, 0 to 1.
  double correlation(PlaneShift a, PlaneShift b) const;
  const float* real(int line) const { return real_.data() + first(line); }
  const float* imaginary(int line) const { return imaginary_.data() + first(line); }

 private:
  std::ptrdiff_t first(int line) const { return static_cast<std::ptrdiff_t>(line) * samples_; }
  int lines_, samples_;
  Grain grain_;
  std::vector<float> real_, imaginary_;
};

// Lateral sigma of the grain over path length: that of a cell of speckle, unless width_rad is
// wider.
double grainAngle(const PointSpread& spread, double width_rad);

// The grain of speckle, for a scene's probe and pulse. width_rad > 0 widens it across the lines:
// full width at half maximum, in intensity.
Grain grainOf(const Scene& scene, double width_rad = 0);

}  // namespace echocine
