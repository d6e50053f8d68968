#pragma once
// The paper's arithmetic average over each point's neighbours, on intensities: as wide as the beam
// at that depth across the lines, as long as half the pulse along them.

#include <span>
#include <vector>

#include "scene/scene.h"

namespace echocine {

// Full two-way width of the beam at a depth, m. Each way is taken as a bell whose width is measured
// where a uniform aperture's far field has fallen by 6 dB (sinc^2 = 1/4): 1.207 lambda z / D.
//   Receive is focused at every depth, as scanners do: w_r = 1.207 lambda z / D.
//   Transmit is focused at F: w_t^2 = w_r^2 + (D (1 - z/F))^2, diffraction and convergence added as
//   squares. Two ways multiply, and the widths of bells as 1/w^2 = 1/w_t^2 + 1/w_r^2.
// Our choice of a closed form: at the focus it is the diffraction width over sqrt 2.
double focusedBeamWidth(double depth_m, double aperture_m, double focus_m, double wavelength_m);

class BeamAverage {
 public:
  BeamAverage(const Probe& probe, const SignalSettings& settings);

  // Averages a line-major plane in place. Windows end at the image's edges and keep their mean
  // there: a constant plane stays constant. The work is shared among threads; the result does not
  // depend on them.
  void apply(std::span<float> plane, std::vector<float>& scratch) const;

 private:
  void averageAxially(std::span<float> line, std::vector<float>& padded) const;
  void averageLaterally(std::span<const float> in, std::span<float> out, int first_sample) const;

  int lines_ = 0, samples_ = 0;
  std::vector<float> taps_;               // axial weights, centre in the middle; empty: none
  std::vector<float> tap_sum_inverse_;    // per sample
  std::vector<double> half_width_lines_;  // per sample; empty: none
};

}  // namespace echocine
