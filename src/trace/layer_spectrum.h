#pragma once
// Any stack: the average over the pulse's spectrum by nodes of frequency.
//
// The pulse is N cycles long, so equally spaced nodes give the mean of anything that repeats after
// a delay exactly, as long as that delay is under 1 / spacing - N: the trapezoidal rule is the
// Gaussian one for it. Nodes are doubled until nothing changes; each time only the new ones are
// computed.

#include "trace/layer_faces.h"

namespace echocine {

// N: half cycles as by wholeHalfCycles().
StackResponse spectrumMean(const LayerFaces& faces, double N);

}  // namespace echocine
