#pragma once
// What interfaces send back in phase with themselves: the part K / (1 + K) of their echoes, K the
// structure's coherent_share. The rest is as random as that of tissue.

#include <span>
#include <vector>

#include "trace/line_samples.h"
#include "trace/trace_settings.h"

namespace echocine {

struct CoherentEchoes {
  // Line-major as the intensities that they are part of: the sum of the coherent parts, and that
  // times exp(-2j k0 l), l each echo's own place. All empty where nothing is coherent.
  std::vector<float> intensity, real, imaginary;

  bool empty() const { return intensity.empty(); }
  void clear(std::size_t size) {
    for (std::vector<float>* plane : {&intensity, &real, &imaginary}) plane->assign(size, 0.0f);
  }
};

// exp(-2j k0 l) of a place on the image's axis.
struct EchoPhase {
  EchoPhase(double depth_m, double wavelength_m);
  double real, imaginary;
};

// Adds those of whole lines and of cells; one of both has none. Preconditions: coherent.clear() for
// all samples; settings.coherent_echoes.
void addCoherent(std::span<const LineTrace> lines, const CellEchoes& cells,
                 const TraceSettings& settings, const Sampling& sampling,
                 const IntensityTerms& parts, CoherentEchoes& coherent);

}  // namespace echocine
