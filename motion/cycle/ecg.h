#pragma once
// The electrocardiogram drawn below a cine.

namespace echocine {

// Lead amplitude relative to the R wave, time_s after the R wave of a beat of duration beat_s; the
// next R wave is at beat_s. Precondition: beat_s > 0.
double ecgAmplitude(double time_s, double beat_s);

// Peak times of the waves in a beat of duration beat_s: T after its R wave, P before the next one.
double tPeakAfterR(double beat_s);
double pPeakBeforeR(double beat_s);

}  // namespace echocine
