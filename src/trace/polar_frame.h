#pragma once
// Output of the trace stage: one frame in beam space.

#include <cstdint>
#include <map>
#include <vector>

#include "core/beam_plane.h"
#include "scene/scene.h"
#include "trace/coherent_echoes.h"
#include "trace/echo_field.h"
#include "trace/line_trace.h"

namespace echocine {

// Planes are line-major: the samples of line 0 from shallow to deep, then those of line 1, and so
// on.
struct PolarFrame {
  int lines = 0, samples = 0;
  std::vector<LineTrace> traces;                 // of each line, before sampling
  CellEchoes cell_echoes;                        // empty unless they are integrated over cells
  std::map<Channel, std::vector<float>> planes;  // the requested intensity channels
  std::vector<std::uint32_t> medium;             // Channel::medium, if requested
  Intensities intensities;                       // input of the signal chain
  CoherentEchoes coherent;                       // part of these; empty unless requested
  EchoField field;                               // of the intensities with speckle, if requested
};

}  // namespace echocine
