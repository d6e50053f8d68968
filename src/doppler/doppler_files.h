#pragma once
// The files of a tissue Doppler loop.

#include <filesystem>
#include <functional>
#include <optional>

#include "core/monitor.h"
#include "doppler/spectrum.h"

namespace echocine {

struct DopplerOptions {
  DopplerRequest request;
  std::optional<SpectrumRequest> spectrum;          // a spectrum too
  std::filesystem::path folder;                     // empty: no files
  bool png = false;                                 // a picture of each frame, besides the GIF
  int threads = 0;                                  // 0: one per core
  std::function<void(const DopplerFrame&)> take{};  // called with each frame, in order
};

// Agreement of the estimate with the truth over the tissue of a loop, where the colour is shown or
// not. Differences are taken modulo 2 v_N.
struct DopplerSummary {
  int frames = 0;
  double nyquist_m_s = 0, bias_m_s = 0, rms_m_s = 0;  // weighted by power
  double aliased_share = 0;  // of tissue samples whose true velocity is beyond v_N
  std::optional<Spectrum> spectrum;
};

// Writes into the folder:
//   velocity/frame_0000.exr  width: lines, height: samples; channels doppler.velocity,
//                            doppler.variance, doppler.power, velocity.beam (truth) and display
//   doppler.gif              colours over the grey picture; velocity/frame_0000.png if requested
//   spectrum.exr, .png, .csv with a spectrum
//   doppler.json             settings, v_N, agreement, digests; written last, sealed
// Throws SceneError, JobError. Without a folder it only measures. An earlier doppler.json is
// removed first, so a folder with one is complete.
DopplerSummary writeDoppler(const Scene& scene, const DopplerOptions& options,
                            const Monitor& monitor = {});

}  // namespace echocine
