#include "scene/beam_profile.h"

#include <cmath>
#include <numbers>

namespace echocine {

double followedWidth(double depth_m, double aperture_m, double wavelength_m) {
  constexpr double kSixDecibelWidth =
      1.2067;  // 2 x for sinc^2(x) = 1/4, sinc(x) = sin(pi x)/(pi x)
  return kSixDecibelWidth * wavelength_m * depth_m / aperture_m;
}

double focusedWidth(double depth_m, double aperture_m, double focus_m, double wavelength_m) {
  return std::hypot(followedWidth(depth_m, aperture_m, wavelength_m),
                    aperture_m * (1 - depth_m / focus_m));
}

double focusedBeamWidth(double depth_m, double aperture_m, double focus_m, double wavelength_m) {
  const double receive = followedWidth(depth_m, aperture_m, wavelength_m);
  const double transmit = focusedWidth(depth_m, aperture_m, focus_m, wavelength_m);
  return transmit > 0 ? receive * transmit / std::hypot(receive, transmit) : 0;
}

double elevationBeamWidth(double depth_m, double aperture_m, double focus_m, double wavelength_m) {
  return focusedWidth(depth_m, aperture_m, focus_m, wavelength_m) / std::numbers::sqrt2;
}

}  // namespace echocine
