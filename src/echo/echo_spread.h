#pragma once
// Spread of echoes by a scanner, estimated from the loop's own speckle, and the resulting
// displacement of visible blood boundaries.

#include "echo/echo_loop.h"

namespace echocine::echo {

// Intensities are spread by a Gaussian of standard deviation `along_m` along the beams and
// `across_rad` times the depth across them: receive is focused at every depth, so its width is an
// angle.
struct EchoSpread {
  double along_m = 0, across_rad = 0;
  double contrast_db = 0;  // of walls relative to blood, as displayed
  int patches = 0;         // number of patches measured

  // Computes k from the contrast, for shift(). Without contrast or patches there is no
  // displacement.
  void prepare();
  // Displacement of the visible boundary into blood, at a range from the apex and with a normal
  // whose angle to the beam has the cosine c:
  // (9)  d = k sqrt((along_m c)^2 + (across_rad range_m)^2 (1 - c^2)).
  // Limit: the boundary is straight over d, and blood and wall are wider than d.
  double shift(double range_m, double c) const;

 private:
  double per_width_ = 0;  // k
};

// (10)  k(C) = -int t dG/dt dt / int dG/dt dt,   G = log(e + (1 - e) Phi(t)),   e = 10^(-C/10):
// the centre of the edge in the logarithm of a wall (t > 0) beside blood, in standard deviations of
// the spread; Phi is the normal distribution. The flank of the wall is visible in the blood: k is
// 0.6 at a contrast of 10 dB, 1.2 at 20, 1.7 at 30, 2.1 at 40.
double edgeShiftPerWidth(double contrast_db);

// From the grey levels of patches of 12 mm, minus a fitted plane. For fully developed speckle,
// spread by Gaussians of width w, log intensities at a distance h in the picture correlate by
// (11)  c = Li2(y) / Li2(1),   -ln y = h_along^2 / (4 w_along^2) + h_across^2 / (4 w_across^2),
// with Li2 the dilogarithm; -ln c is 1.5 (-ln y) within a tenth for c from 0.15 to 0.6. The
// standard deviation is 5.57 dB, which gives the display's grey levels per decibel, and hence the
// contrast of blood and walls. Structure only widens the apparent correlation, and darker patches
// contain less structure, so the lower quartile of the darkest quarter is used.
EchoSpread measureSpread(const EchoLoop& real, double metres_per_pixel);

}  // namespace echocine::echo
