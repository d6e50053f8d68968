#pragma once
// The coherent part of interface echoes: the fraction K / (1 + K), with K the structure's
// coherent_share. The rest is random like that of tissue.

#include <span>
#include <vector>

#include "trace/line_samples.h"
#include "trace/trace_settings.h"

namespace echocine {

struct CoherentEchoes {
  // Line-major like the intensities that contain them: the sum of the coherent parts, and that
  // times exp(-2j k0 l), with l the place of each echo. All are empty without coherent echoes.
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

// Adds the echoes of whole lines and of cells; one of the two is empty. Preconditions:
// coherent.clear() for all samples; settings.coherent_echoes.
void addCoherent(std::span<const LineTrace> lines, const CellEchoes& cells,
                 const TraceSettings& settings, const Sampling& sampling,
                 const IntensityTerms& parts, CoherentEchoes& coherent);

}  // namespace echocine
