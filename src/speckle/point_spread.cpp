#include "speckle/point_spread.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/beam_profile.h"
#include "scene/sampled_beam.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// w of the envelope over the pulse's length, our choice: it gives what real loops show.
constexpr double kWidthPerPulse = 0.893;
constexpr double kNearest_m = 3e-3;

}  // namespace

// A bell in intensity of full width w at -6 dB has in amplitude sigma = sqrt 2 w / sqrt(8 ln 4).
double bell(double distance, double deviation) {
  if (!(deviation > 0)) return distance == 0 ? 1 : 0;
  const double away = distance / deviation;  // before it is squared: a tiny square would be 0
  return std::exp(-0.5 * away * away);
}

PointSpread::PointSpread(const Probe& probe, double pulse_cycles, bool harmonic)
    : wavelength_m(ScanGeometry(probe).wavelength()),
      axial_width_m(kWidthPerPulse * pulse_cycles * wavelength_m / 2),
      aperture_m(probe.elevation_aperture_m),
      focus_m(probe.elevation_focus_m),
      probe_(probe),
      pulse_cycles_(pulse_cycles) {
  axial_m = std::numbers::sqrt2 * axial_width_m / kWidthPerDeviation;
  angle_rad = speckleWidening(probe.receive_apodization, harmonic) *
              followedWidth(1, probe.aperture_m, wavelength_m) / kWidthPerDeviation;
}

namespace {

// Harmonic, downshift and receiving aperture belong to the sampled beam (planPulse()).
bool isSampled(const Scene& scene) {
  return scene.signal.beam_width == BeamWidth::profile && scene.accuracy.rays_per_beam == 1;
}

}  // namespace

PointSpread::PointSpread(const Scene& scene)
    : PointSpread(scene.probe, scene.signal.pulse_cycles,
                  scene.signal.harmonic && isSampled(scene)) {
  const SignalSettings& s = scene.signal;
  if (!isSampled(scene) || scene.probe.lines == 1) return;
  if (s.downshift) attenuation_np_per_m_hz_ = s.nominal_gain_np_per_m_hz;
  receive_f_number_ = s.receive_f_number;
}

double PointSpread::widening(double path_m) const {
  return attenuation_np_per_m_hz_ > 0
             ? 1 / downshiftOf(probe_, pulse_cycles_, attenuation_np_per_m_hz_, path_m)
             : 1;
}

double PointSpread::receiving(double path_m) const {
  return receivingPart(probe_, receive_f_number_, path_m);
}

double PointSpread::angle(double path_m) const {
  return widening(path_m) * angle_rad / receiving(path_m);
}

double PointSpread::lateralWidth(double path_m) const {
  return angle_rad * kWidthPerDeviation / std::numbers::sqrt2 * path_m;
}

double PointSpread::elevationWidth(double path_m) const {
  return elevationBeamWidth(path_m, aperture_m, focus_m, wavelength_m);
}

double PointSpread::cellVolume(double path_m) const {
  const double held_m = std::max(path_m, kNearest_m);
  return axial_width_m * lateralWidth(held_m) * elevationWidth(held_m);
}

}  // namespace echocine
