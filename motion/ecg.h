#pragma once
// The electrocardiogram that is drawn under a cine.

namespace echocine {

// Lead amplitude relative to the R wave at a phase in [0, 1), R wave at phase 0.
double ecgAmplitude(double phase);

}  // namespace echocine
