#pragma once
#include <vector>

#include "motion/cycle/cardiac_clock.h"

namespace echocine {

// The lead of ecgAmplitude() over a whole loop, at evenly spaced instants from its first frame to
// the end of its last. They are denser than a picture's columns and than a QRS complex.
std::vector<double> loopEcg(const CardiacClock& clock, double frame_rate_hz);

}  // namespace echocine
