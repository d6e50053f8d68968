#pragma once
// Tissue Doppler: velocities along the scan lines, measured from packets of pulses.

#include <vector>

#include "core/beam_plane.h"
#include "doppler/autocorrelation.h"
#include "frame/simulator.h"
#include "motion/cycle/frame_time.h"

namespace echocine {

// Most pulses of a packet: those of one frame are in memory together. Our choice.
inline constexpr int kMostPulses = 64;

struct DopplerRequest {
  int pulses = 4;        // of a packet
  double prf_hz = 1000;  // pulses a second on each line
  double gate_m = 1e-3;  // along the line, over which (D1) sums
  WallFilterKind wall = WallFilterKind::none;
};

// Line-major planes. Velocities are NaN where the truth has no motion: in blood, which has no flow
// field, and in the background.
struct DopplerFrame {
  FrameTime time;
  VelocityPlanes measured;
  std::vector<float> exact_m_s;  // the truth velocity.beam at the frame's instant
  Greys greys;                   // of the frame's instant, 0 black to 1 white
};

// The scene with the outputs and the truth that Doppler needs. Speckle is on, because only
// scatterers have a phase. Rolling lines, persistence and drawn files are off. Throws SceneError,
// named by option, for a packet that does not fit: PRF above c / (2 depth), or a packet longer than
// a frame.
Scene dopplerScene(Scene scene, const DopplerRequest& request);

// The field that one pulse receives on some lines, with clutter and noise of the scene. white: of
// the loop. Planes have all lines; the content of the others is undefined.
PulseField receivePulse(const Simulator& simulator, const FrameTime& time, double white,
                        LineRange lines);

// A frame of the loop, from pulses centred on its instant, which all lines share as parallel
// receive beams do. Precondition: the simulator is of dopplerScene(). Thread-safe.
DopplerFrame makeDopplerFrame(const Simulator& simulator, const DopplerRequest& request, int frame,
                              double white);

}  // namespace echocine
