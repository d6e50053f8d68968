#pragma once
// Small loops in beam space, as archives take them.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "archive/beam_loop.h"
#include "motion/cycle/ecg.h"

namespace echocine::support {

// A blob that moves in a sector from -30 to 25 degrees: `frames` frames, 20 a second, beats of 0.8
// s from the first frame on.
inline echocine::BeamLoop smallBeamLoop(int frames = 33) {
  constexpr double kBeat_s = 0.8, kRate_hz = 20;
  echocine::BeamLoop loop;
  Probe& probe = loop.scene.probe;
  probe.kind = ProbeKind::phased;
  probe.first_angle_rad = -30 * std::numbers::pi / 180;
  probe.last_angle_rad = 25 * std::numbers::pi / 180;
  probe.min_depth_m = 0.004;
  probe.max_depth_m = 0.084;
  probe.lines = loop.lines = 23;
  probe.samples = loop.samples = 40;
  probe.frequency_hz = 2.5e6;
  loop.frames = frames;
  loop.scene.acquisition.frame_rate_hz = kRate_hz;
  for (int t = 0; t < frames; ++t) {
    loop.times_s.push_back(static_cast<float>(t / kRate_hz));
    const double phase = 2 * std::numbers::pi * t / (kRate_hz * kBeat_s);
    for (int k = 0; k < loop.samples; ++k)
      for (int i = 0; i < loop.lines; ++i) {
        const double along = (k - 20 - 6 * std::cos(phase)) / 7,
                     across = (i - 11 - 2 * std::sin(phase)) / 4;
        loop.greys.push_back(
            static_cast<float>(0.05 + 0.9 * std::exp(-along * along - across * across)));
        loop.beam_m_s.push_back(0.01f);
      }
  }
  const double end_s = frames / kRate_hz + kEcgMargin_s;
  for (int n = 0; n / kEcgRate_hz < end_s + kEcgMargin_s; ++n) {
    const double time_s = n / kEcgRate_hz - kEcgMargin_s;
    loop.ecg.push_back(
        static_cast<float>(ecgAmplitude(time_s - kBeat_s * std::floor(time_s / kBeat_s), kBeat_s)));
  }
  return loop;
}

}  // namespace echocine::support
