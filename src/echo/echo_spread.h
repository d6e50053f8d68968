#pragma once
// How far a scanner spreads echoes, from the loop's own speckle; and how far from itself a boundary
// of blood is seen for it.

#include "echo/echo_loop.h"

namespace echocine::echo {

// Intensities are spread by a bell of standard deviation `along_m` along the beams and `across_rad`
// times the depth across them: receive is focused at every depth, so its width is an angle.
struct EchoSpread {
  double along_m = 0, across_rad = 0;
  double contrast_db = 0;  // of walls against blood, as displayed
  int patches = 0;         // that it was measured in

  // k of the contrast, for shift(). Without it, or without patches, nothing is seen shifted.
  void prepare();
  // How far into blood its boundary is seen, at a range from the apex and with a normal at an angle
  // of cosine c to the beam:
  // (9)  d = k sqrt((along_m c)^2 + (across_rad range_m)^2 (1 - c^2)).
  // For a boundary that is straight over d, beside blood and wall that are wider than d.
  double shift(double range_m, double c) const;

 private:
  double per_width_ = 0;  // k
};

// (10)  k(C) = -int t dG/dt dt / int dG/dt dt,   G = log(e + (1 - e) Phi(t)),   e = 10^(-C/10):
// the middle of the edge that a logarithm shows of a wall (t > 0) beside blood, in standard
// deviations of the spread; Phi is the normal distribution. Blood shows the flank of the wall: 0.6
// at a contrast of 10 dB, 1.2 at 20, 1.7 at 30, 2.1 at 40.
double edgeShiftPerWidth(double contrast_db);

// From the greys of patches of 12 mm, less the plane through them. Fully developed speckle spread
// by bells of w has, h apart in the picture, log intensities that correlate by
// (11)  c = Li2(y) / Li2(1),   -ln y = h_along^2 / (4 w_along^2) + h_across^2 / (4 w_across^2),
// Li2 the dilogarithm; -ln c is 1.5 (-ln y) within a tenth for c from 0.15 to 0.6. Its standard
// deviation is 5.57 dB, which tells the display's greys to the decibel, of blood and of walls.
// Structure only widens what a patch shows and darker patches have less of it: the lower quartile
// of the darkest quarter counts.
EchoSpread measureSpread(const EchoLoop& real, double metres_per_pixel);

}  // namespace echocine::echo
