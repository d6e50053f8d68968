#pragma once
// The electrocardiogram that is drawn under a cine.

namespace echocine {

// Lead amplitude relative to the R wave, time_s after the R wave that begins a beat of beat_s; the
// next R wave is at beat_s. Precondition: beat_s over 0.
double ecgAmplitude(double time_s, double beat_s);

// Times of the waves' peaks in a beat of beat_s: T after its R wave, P before the next one.
double tPeakAfterR(double beat_s);
double pPeakBeforeR(double beat_s);

}  // namespace echocine
