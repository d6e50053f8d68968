#pragma once
// Acquisition time of each column of an ECG trace, from the changes between frames.

#include <optional>
#include <string>
#include <vector>

#include "echo/ecg_curve.h"

namespace echocine::echo {

// A trace over time: evenly spaced samples, from the first to the last visible one.
struct EcgSignal {
  std::string kind;               // "sweeping", "scrolling", "still, with a marker"
  std::vector<double> height_px;  // above the usual row; NaN if hidden
  double first_frame = 0;         // time of the first sample, in frames; may precede the loop
  double px_per_frame = 0;        // samples per frame
  double confidence = 0;          // 0..1: share of the frames that this explains
  double instantOf(double sample) const { return first_frame + sample / px_per_frame; }
};

// A place of change that advances by the same step each frame: the head of a sweeping trace, or a
// marker over a static one. Columns are acquired as it passes. None without such a place.
std::optional<EcgSignal> signalOfHead(const EcgCurve& curve);

// The whole trace moves to the left by the same step: its right end is the present.
std::optional<EcgSignal> signalOfScroll(const EcgCurve& curve);

}  // namespace echocine::echo
