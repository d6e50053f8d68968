#pragma once
// Adds scatterers up at the samples nearest to them: what the point spread function then smears.

#include <cstdint>
#include <vector>

#include "speckle/scatterers.h"

namespace echocine {

// One sample: sum of c e exp(-2j k0 r), its real and imaginary part, and sum of e^2. One load and
// store for each scatterer.
struct EchoSum {
  float real = 0, imaginary = 0, squares = 0, unused = 0;
};

// Line-major sums of a frame, and a place for each lane that nobody reads.
struct EchoSums {
  int lines = 0, samples = 0;
  std::vector<EchoSum> sums;
  EchoSum* line(int i) {
    return sums.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(samples);
  }
};

// The Gaussian numbers of a batch at an instant: a mix of two draws, of variance 1.
struct GaussianMix {
  const float *real_a, *imaginary_a, *real_b, *imaginary_b;
  float a = 1, b = 0;
};

// Which draws: c(t) = cos(pi f/2) c_m + sin(pi f/2) c_(m+1) with m + f = t / tau + a batch's own
// phase, so that no instant renews all at once. tau = 0: never renewed.
GaussianMix mixAt(const GaussianTable& table, std::uint64_t pattern, double time_s, double tau_s);

class Splatter {
 public:
  Splatter(const Probe& probe, const PointSpread& spread, const BeamView& view);

  // The scatterers of a cube whose corners are here now. Phases hold the path and, across the
  // imaging plane, the curvature of the lens's wave, which makes the correlation after a shift d
  // exp(-d^2 / 2 s0^2) at every depth, s0 the deviation by diffraction alone.
  void add(const CubeCorners& corners, const Scatterers& scatterers, const ScattererBatch& batch,
           const GaussianMix& mix, EchoSums& sums) const;

 private:
  const BeamView& view_;
  int lines_, samples_;
  float min_depth_m_, per_spacing_, turns_per_m_;
  float diffraction_ = 0, lens_m_ = 0, per_focus_ = 0;
};

}  // namespace echocine
