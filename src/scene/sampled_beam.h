#pragma once
// Two-way intensity profile of a beam, with its side lobes, as a sum over the elements of the
// aperture:
//
//   P(u, q) = sum_f g_f |sum_n exp(j k_f u x_n) exp(-j k_f x_n^2 q / 2)|^2
//                       |sum_n a_n exp(j k_f u x_n)|^2                                        (B1)
//   q = cos^2(theta) (1/z - 1/F)                                                              (B2)
//
// Symbols: u sine of a direction less that of the beam, both from the normal of the aperture; q
// defocus of the transmitted beam, 1/m; theta steering angle; z path length; F focus; x_n places of
// the elements, at most 0.45 of the shortest wavelength apart; a_n receive apodization; k_f = 2 pi
// f / c; g_f weights of five frequencies, a Gaussian about the centre. Transmit has no apodization;
// receive is focused at every depth. Its energy over the pulse, not the peak of the envelope.
//
// Second-harmonic imaging (signal/harmonic.h) sends at half the frequency, and the harmonic has the
// square of the sent intensity: the first sum is then |sum_n exp(j k_f u x_n / 2) ...|^4, with k_f
// / 2 in its defocus too.
//
// Limits: an aperture over 57 shortest wavelengths has 128 elements, farther apart; beyond 0.9 of
// the u of their first grating lobe P counts as 0. Paraxial in q, so paths nearer than half the
// aperture keep the value there. Full widths differ from a sum over the elements with exact
// distances by at most 10 % (-6 dB) and 20 % (-20 dB) for 64 elements of 0.3 mm focused at 80 mm,
// at 30 to 140 mm and 0 to 38 degrees. For apertures of 12 to 24 mm, foci of 50 to 120 mm and
// apodized receive it is 15 %, steered at 30 mm up to 25 %. Against a linear array simulator
// (SIMUS: Garcia, Comput. Methods Programs Biomed. 218, 2022): 4 % (-6 dB) and 15 % (-20 dB),
// except where a shoulder of the defocused beam lies near -20 dB.

#include <cstddef>
#include <span>
#include <vector>

#include "scene/probe.h"

namespace echocine {

// Standard deviation of the intensity spectrum of a received pulse over its centre frequency:
// a pulse of some cycles and the transducer's bandwidth, both as Gaussians of their -6 dB widths.
double spectrumDeviation(double pulse_cycles, double bandwidth);

// Lateral width of a speckle cell over that of a uniform receiving aperture, at the focus. The
// field's correlation is the transform of |H|^2, H the convolution of both apertures (van Cittert,
// Zernike); widths are inverse to the deviation of |H|^2. The second harmonic is the square of a
// wave of half the frequency, so the sent aperture is a triangle: the convolution of a uniform one
// of half the width with itself.
double speckleWidening(Apodization receive, bool harmonic = false);

// Part of the aperture that receives from a path length: it grows with depth as z / (N D), from 1/4
// (our choice) to 1. N: receive F-number; 0: the whole aperture from every depth. Sent waves are
// defocused and even there, so beam and speckle cells are wider by the inverse. From 3 mm on, the
// cells of (van Cittert, Zernike) with defocus are 0 to 7 % wider than that for uniform apertures
// focused at 80 mm. Limits: those of the second harmonic are up to 27 % narrower, and those of
// Hann's apodization up to 1.9 times as wide, as they are near the face without this key.
double receivingPart(const Probe& probe, double f_number, double path_m);

// Centre frequency of the echo from a path length over that of the pulse: attenuation alpha f,
// alpha in Np/(m Hz) of amplitude, moves the centre of a Gaussian spectrum to
//   f0 - 4 alpha z sigma^2                                                                     (B5)
// with sigma the deviation of its intensity, in Hz. Limit: at least 0.5. Widths grow as its
// inverse.
double downshiftOf(const Probe& probe, double pulse_cycles, double attenuation_np_per_m_hz,
                   double path_m);

class SampledBeam {
  // For one u: the integral of P from 0 to it, and P per step of the table.
  struct Entry {
    double integral, power;
  };

 public:
  SampledBeam(const Probe& probe, double pulse_cycles, bool harmonic = false);

  // Of (B2); steering: sin(theta).
  double defocus(double path_m, double steering) const;

  // One defocus. It refers to its beam.
  class Profile {
   public:
    // Integral of P from 0 to u over that from -1 to 1; odd in u. Limit: |u| beyond 2 counts as 2.
    double integral(double u) const;
    // P is less than a thousandth of its peak beyond this u, except in a defocused grating lobe.
    double mainLobe() const { return main_lobe_; }

   private:
    friend class SampledBeam;
    const Entry *low_ = nullptr, *high_ = nullptr;  // of the defocus below and above
    double share_ = 0;                              // of the higher one
    double steps_per_u_ = 0;
    std::size_t last_ = 0;
    double main_lobe_ = 0;
  };
  Profile at(double defocus) const;

 private:
  void fill(const Probe& probe, double pulse_cycles, bool harmonic);
  void integrate(std::span<const double> powers);

  double aperture_m_, focus_m_;
  double first_defocus_, defocus_step_;
  double steps_per_u_;
  std::size_t defocuses_, steps_;   // rows, and entries of a row
  std::vector<Entry> entries_;      // by defocus and u
  std::vector<double> main_lobes_;  // by defocus
};

}  // namespace echocine
