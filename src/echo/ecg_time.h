#pragma once
// When each column of an ECG trace was acquired, told by what changes from frame to frame.

#include <optional>
#include <string>
#include <vector>

#include "echo/ecg_curve.h"

namespace echocine::echo {

// A trace over time: evenly spaced samples, from the first to the last that the picture shows.
struct EcgSignal {
  std::string kind;               // "sweeping", "scrolling", "still, with a marker"
  std::vector<double> height_px;  // above the usual row; NaN where the trace is hidden
  double first_frame = 0;         // instant of the first sample, in frames; may lie before the loop
  double px_per_frame = 0;        // samples per frame
  double confidence = 0;          // 0..1: the part of the frames that this explains
  double instantOf(double sample) const { return first_frame + sample / px_per_frame; }
};

// A place that changes moves on by the same step from frame to frame: the head of a sweeping trace,
// which draws it anew, or a marker over one that stands still. Its columns are acquired as it
// passes. Nothing where no place moves so.
std::optional<EcgSignal> signalOfHead(const EcgCurve& curve);

// The whole trace moves to the left by the same step: its right end is now.
std::optional<EcgSignal> signalOfScroll(const EcgCurve& curve);

}  // namespace echocine::echo
