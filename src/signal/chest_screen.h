#pragma once
// Uneven transmission of the chest wall: patches of fat, muscle, cartilage and lung in front of the
// heart weaken parts of the aperture, so borders fade in some directions.

#include <vector>

#include "scene/scene.h"

namespace echocine {

// A screen at one depth d. At the lateral place x it passes the amplitude
//
//   t(x) = 10^(-s n(x) / 20) / exp((s ln 10 / 20)^2 / 2)                                      (S1)
//
// with s the deviation in dB of one passage and n a standard normal field, smooth over the grain;
// the mean of t is 1. Elements of the aperture D at the start of a line reach (x, z) through the
// part of the screen from (start - D/2)(1 - q) + x q to (start + D/2)(1 - q) + x q with
// q = (d - z0) / (z - z0), z0 the depth of the start: 0, or negative on a curved face. Both
// ways, the intensity factor is the fourth power of the mean of t over that part. Between face and
// screen the loss grows in dB with the depth, t(x)^(4 (z - z0)/(d - z0)), as in a wall of even
// thickness. An aperture much smaller than the grain has 2 s dB of variation, a much larger one
// none. Energy fluctuations of 1.6 dB over a few mm were measured behind chest walls (Hinkelman et
// al., J. Acoust. Soc. Am. 101, 2365-2373, 1997); larger patches are our choice.
class ChestScreen {
 public:
  ChestScreen(const Probe& probe, const ArtefactSettings& settings);

  // Points in the probe frame, from the centre of the face.
  double factor(double start_x_m, double x_m, double z_m, double start_z_m = 0) const;
  // Mean of t from left to right; t beyond 0.25 m is that at 0.25 m.
  double mean(double left_m, double right_m) const;

 private:
  double integral(double x_m) const;  // of t, from the table's first place

  double aperture_m_, depth_m_, step_m_;
  std::vector<double> sums_;
};

}  // namespace echocine
