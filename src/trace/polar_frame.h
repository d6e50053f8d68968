#pragma once
// What the trace stage hands on: one frame in beam space.

#include <cstdint>
#include <map>
#include <vector>

#include "core/beam_plane.h"
#include "scene/scene.h"
#include "trace/coherent_echoes.h"
#include "trace/line_trace.h"

namespace echocine {

// Planes are line-major: the samples of line 0 from shallow to deep, then those of line 1, and so
// on.
struct PolarFrame {
  int lines = 0, samples = 0;
  std::vector<LineTrace> traces;                 // of each line, before sampling
  CellEchoes cell_echoes;                        // none unless they are integrated over cells
  std::map<Channel, std::vector<float>> planes;  // the intensity channels that were asked for
  std::vector<std::uint32_t> medium;             // Channel::medium, if asked for
  Intensities intensities;                       // where the signal chain starts
  CoherentEchoes coherent;                       // part of these; empty unless asked for
};

}  // namespace echocine
