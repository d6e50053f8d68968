#pragma once
// From scatterers to splats: current position in beam space, phase and weight of each.

#include <cstdint>

#include "speckle/scatterers.h"
#include "speckle/splat_lists.h"

namespace echocine {

// The Gaussian numbers of a batch at an instant: a mixture of two draws, with variance 1.
struct GaussianMix {
  const float *real_a, *imaginary_a, *real_b, *imaginary_b;
  float a = 1, b = 0;
  // Amplitude factors by scatterer, or none. The normaliser leaves these factors out.
  const float* strength = nullptr;

  Floats8 real(std::uint32_t j) const { return weighed(j, mixed(real_a + j, real_b + j)); }
  Floats8 imaginary(std::uint32_t j) const {
    return weighed(j, mixed(imaginary_a + j, imaginary_b + j));
  }

 private:
  Floats8 weighed(std::uint32_t j, Floats8 c) const {
    return strength ? lanesAt(strength + j) * c : c;
  }
  Floats8 mixed(const float* one, const float* two) const {
    return b == 0 ? lanesAt(one) : a * lanesAt(one) + b * lanesAt(two);
  }
};

// The mixture c(t) = cos(pi f/2) c_m + sin(pi f/2) c_(m+1) with m + f = t / tau + a batch's own
// phase, so that renewals are not simultaneous. tau = 0: no renewal.
// staggered: patterns are renewed at different times. Else all together, from time 0 on, where the
// mix is that of a pattern without renewal.
GaussianMix mixAt(const GaussianTable& table, std::uint64_t pattern, double time_s, double tau_s,
                  bool staggered = true);

class Splatter {
 public:
  Splatter(const Probe& probe, const PointSpread& spread);

  // Adds the scatterers of a cube with the given current corners. Phases contain the path and,
  // across the imaging plane, the curvature of the lens's wave. The correlation after a shift d is
  // thus exp(-d^2 / 2 s0^2) at every depth, with s0 the standard deviation by diffraction alone.
  void add(const BeamCube& cube, const Scatterers& scatterers, const ScattererBatch& batch,
           const GaussianMix& mix, SplatLists& splats) const;

  // Eight scatterers at their own places, with the mixture's numbers from `j` on.
  void addPlaces(const BeamCube& at, const GaussianMix& mix, std::uint32_t j,
                 SplatLists& splats) const;

 private:
  // Turns of phase added by the lens at the cut, over a cube's samples.
  struct Bend {
    float first, slope;
    Floats8 at(Floats8 sample) const { return first + sample * slope; }
  };
  Bend bendOf(Floats8 sample) const;
  void addLanes(const BeamCube& at, Floats8 lens_turns, const GaussianMix& mix, std::uint32_t j,
                std::uint32_t count, SplatLists& splats) const;

  float samples_;
  float turns_per_sample_, turns_before_;
  float min_depth_m_, spacing_m_, bend_, bend_at_focus_;
};

}  // namespace echocine
