#pragma once
// Extent of one scatterer's echo in beam space, by the model of this room's README.
//
// Symbols: lambda wavelength, D aperture, z path length, w full width at -6 dB of the two-way
// intensity profile, sigma standard deviation of the amplitude's Gaussian. Lateral: a constant
// angle at every depth, sigma = 0.3625 lambda z / D times the widening by receive apodization and
// by harmonic imaging at the focus; defocus widens the beam, but not the speckle.
//
// Downshift: a cell has the same number of wavelengths at every depth, so its axial and lateral
// sigma grow as the inverse of (B5) of scene/sampled_beam.h. A linear array simulator has 4 % more
// or 2 % less along the lines (3 to 14 cm, 0.5 dB/(cm MHz)); its spectrum is no Gaussian.
//
// Receive F-number: near the face only a part of the aperture receives, and the lateral sigma grows
// as the inverse of receivingPart() of scene/sampled_beam.h.

#include "scene/scene.h"

namespace echocine {

// Full width at half maximum of a Gaussian, in standard deviations: sqrt(8 ln 2).
inline constexpr double kWidthAtHalf = 2.3548200450309493;

// exp(-(distance / deviation)^2 / 2); for deviation 0 it is 1 at the centre and 0 elsewhere.
double bell(double distance, double deviation);

// Gaussians are cut where 4 % of the amplitude remains.
inline constexpr double kCutDeviations = 2.5;

struct PointSpread {
  // pulse_cycles: of the signal's pulse.
  PointSpread(const Probe& probe, double pulse_cycles, bool harmonic = false);
  // By the probe and the signal of a scene.
  explicit PointSpread(const Scene& scene);

  double wavelength_m = 0;
  double axial_m = 0;                  // sigma
  double axial_width_m = 0;            // w: 0.55 mm at 2.5 MHz and 2 cycles, as real loops show
  double angle_rad = 0;                // lateral sigma over path length, at the focus
  double aperture_m = 0, focus_m = 0;  // of the lens across the imaging plane

  double lateralWidth(double path_m) const;    // w
  double elevationWidth(double path_m) const;  // w_e
  // Factor of axial_m at a path length; 1 without downshift.
  double widening(double path_m) const;
  // Part of the aperture that receives from there.
  double receiving(double path_m) const;
  // Lateral sigma over path length there.
  double angle(double path_m) const;
  // Volume of a resolution cell without downshift; limited near the probe to its value at 3 mm of
  // path, because it would vanish.
  double cellVolume(double path_m) const;

 private:
  // For downshift and receiving aperture; attenuation and F-number are 0 without them.
  Probe probe_;
  double pulse_cycles_ = 0, attenuation_np_per_m_hz_ = 0, receive_f_number_ = 0;
};

// The Gaussian of the elevation is cut beyond this part of w_e, where the amplitude is a tenth.
inline constexpr double kElevationCut = 0.9;

}  // namespace echocine
