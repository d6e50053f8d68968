#pragma once
// Spectral tissue Doppler at a place: velocities of one sample volume over time.
//
//   S(v, t) = 1/K sum over k of |sum over n of h_n z_k(t_n) exp(-j pi (v / v_N) n)|^2 / sum h_n^2
//                                                                                             (D5)
//
// Symbols: z_k(t_n) field of sample k of the sample volume at the pulses t_n about t, PRF apart;
// K number of these samples; h Hann window about t, also where the loop ends within it; v velocity,
// positive towards the probe; v_N Nyquist velocity. Tissue that moves at v turns the phase of z by
// pi v / v_N from pulse to pulse. Velocities beyond v_N wrap round.

#include <optional>
#include <vector>

#include "core/monitor.h"
#include "doppler/doppler.h"
#include "mmode/line_place.h"

namespace echocine {

struct SpectrumPlace {
  std::optional<double> place;         // of the line: rad; linear probes: m
  std::optional<double> depth_m;       // of the volume's middle
  std::optional<MModeTarget> through;  // instead of both: a place of the heart at end-diastole
};

struct SpectrumRequest {
  SpectrumPlace at;
  double volume_m = 5e-3;   // length of the sample volume
  double window_s = 0.032;  // of the pulses for one spectrum
  double step_s = 0.002;    // from spectrum to spectrum
};

// Velocity bin b of column t has the index t * bins + b, from -v_N on; its middle is
// v_N (2 (b + 0.5) / bins - 1).
struct Spectrum {
  int columns = 0, bins = 0, line = 0;
  double depth_m = 0, nyquist_m_s = 0;
  std::vector<FrameTime> times;
  std::vector<float> power;      // relative to I_S
  std::vector<double> mean_m_s;  // by (D2) over the window and the volume; NaN without a signal
  // By mesh: of a ring, its point in the plane; else the mean over the volume's tissue, NaN
  // without.
  std::vector<double> exact_m_s;
  double mean_peak = 0, exact_peak = 0;  // largest of each up to the closure of the aortic valve
};

// The scene that makeSpectrum() needs: that of dopplerScene(), with the heart's function if a place
// of the heart is requested. Throws SceneError for values out of range.
Scene spectrumScene(Scene scene, const DopplerRequest& request, const SpectrumRequest& spectrum);

// Throws SceneError for a place outside the sector or one that the plane does not show, and for too
// many pulses. Precondition: the simulator is of spectrumScene().
void checkSpectrum(const Simulator& simulator, const DopplerRequest& request,
                   const SpectrumRequest& spectrum);

// Throws like checkSpectrum(); JobError if the monitor stops it.
Spectrum makeSpectrum(const Simulator& simulator, const DopplerRequest& request,
                      const SpectrumRequest& spectrum, double white, const Monitor& monitor);

}  // namespace echocine
