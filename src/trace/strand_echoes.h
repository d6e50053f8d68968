#pragma once
// Echoes of strands much thinner than the beam, such as chordae.

#include <span>

#include "core/ids.h"
#include "core/vec3.h"
#include "trace/polar_frame.h"
#include "trace/trace_frame.h"

namespace echocine {

// A polyline in the probe frame, m.
struct Strand {
  std::span<const Vec3f> points;
  MediumId medium{};
  double backscatter = 1;  // relative to that of its medium, across the strand
};

// Loss of a strand along the beam relative to one across it, dB: its fibres run along it. That of
// muscle along its fibres, between walls in vivo.
inline constexpr double kStrandAnisotropy_db = 15.9;

// Adds strands of a diameter (m) to the intensities of a traced frame. A piece of the length ds
// replaces the volume pi/4 d^2 ds of the medium around it. Across the imaging plane the beam weighs
// it by the Gaussian of the lens (scene/elevation_slices.h). Its intensity is the excess of the
// strand's backscatter over that of the medium, with the losses of its line and the loss of
// kStrandAnisotropy_db times the squared cosine of its angle to the line. It is shared among the
// four samples around the piece, so the sum over cells is that of the volume. Strands reflect and
// attenuate nothing, and add nothing in a medium that scatters as much.
// Precondition: the frame holds the traces of its lines, at least two.
void addStrands(std::span<const Strand> strands, double diameter_m, const Probe& probe,
                const TraceSettings& settings, const IntensityTerms& terms, PolarFrame& frame);

}  // namespace echocine
