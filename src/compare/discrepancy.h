#pragma once
// One number for optimisers: how far synthetic frames are from real ones.

#include <memory>
#include <span>
#include <vector>

#include "compare/beam_grid.h"
#include "compare/calibration.h"
#include "scene/probe.h"

namespace echocine::compare {

// With x the calibrated synthetic and y the real grey over the sector (area-weighted), s the
// standard deviation of y over the whole loop, and GC the gradient correlation of x and y,
//   D = 1/2 RMS(x - y) / s + 1/2 (1 - GC).
// 0 for equal frames; about 1 when the synthetic frame says nothing of the real one (the calibrated
// mean has RMS = s, unrelated edges GC = 0); above 1 when it misleads. The first part sees where it
// is bright and dark, the second where edges run; both are blind to brightness and contrast, which
// calibration takes out. The loop's number is the mean over its frames.
double discrepancyOf(double rms, double real_deviation, double gradient_correlation);

// Built once from a real loop; each call takes a synthetic frame in beam space as the tracer makes
// it (grey 0 to 1 after log compression, line-major) and needs no file.
class Discrepancy {
 public:
  // The real loop is resampled to the lines of `probe` and to at most 384 of its depths. `knots`:
  // of the calibration. Throws SceneError when the sectors do not overlap or the loop has no scale.
  Discrepancy(const Loop& real, const Probe& probe, const Placement& placement = {}, int knots = 8);

  int realFrames() const { return static_cast<int>(real_.frames.size()); }

  // Calibrates the frame to real frame `frame` by itself, unless calibrate() came before.
  double operator()(int frame, std::span<const float> grey) const;

  // Fits one curve for the whole loop: pairs of real frame and synthetic grey.
  void calibrate(const std::vector<std::pair<int, std::vector<float>>>& pairs);
  const GreyCurve& curve() const { return curve_; }

 private:
  std::vector<float> reduced(std::span<const float> grey) const;

  Probe probe_;
  BeamGrid grid_;
  BeamLoop real_;
  std::vector<float> weights_;
  double deviation_ = 1;
  int knots_, first_sample_ = 0, per_sample_ = 1, first_line_ = 0;
  GreyCurve curve_;
};

// Standard deviation of a loop's greys over all frames and weights.
double loopDeviation(const std::vector<std::vector<float>>& frames, std::span<const float> weights);

}  // namespace echocine::compare
