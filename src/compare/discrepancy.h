#pragma once
// One number for optimisers: how far synthetic frames are from real ones.

#include <optional>
#include <span>
#include <vector>

#include "compare/beam_grid.h"
#include "compare/calibration.h"
#include "scene/probe.h"

namespace echocine::compare {

// Both frames are smoothed by a Gaussian of standard deviation 2 % of the depth (3 mm in 15 cm; our
// choice): the model has no speckle, so they are compared at the scale of walls. With x the
// calibrated synthetic and y the real grey after that over the sector (area-weighted), s the
// standard deviation of y over the whole loop, and GC the gradient correlation of x and y,
//   D = 1/2 RMS(x - y) / s + 1/2 (1 - GC).
// 0 for equal frames; about 1 when the synthetic frame says nothing of the real one (the calibrated
// mean has RMS = s, unrelated edges GC = 0); above 1 when it misleads. The first part sees where it
// is bright and dark, the second where edges run; both are blind to brightness and contrast, which
// calibration takes out. The loop's number is the mean over its frames.
inline constexpr double kSmoothingShare = 0.02;
double discrepancyOf(double rms, double real_deviation, double gradient_correlation);

// A frame as the discrepancy sees it: smoothed within the area that weighs (values elsewhere are
// 0).
class Smoother {
 public:
  Smoother(const BeamGrid& grid, std::span<const float> weights);
  std::vector<float> operator()(std::span<const float> frame) const;

 private:
  int lines_, samples_;
  double along_, across_;            // standard deviations in samples and lines
  std::vector<float> mask_, share_;  // 1 within the area; how much of the window lies in it
};

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
  std::vector<float> smoothed(std::span<const float> grey) const;

  Probe probe_;
  BeamGrid grid_;
  BeamLoop real_;  // smoothed
  std::vector<float> weights_;
  std::optional<Smoother> smoother_;
  double deviation_ = 1;
  int knots_, per_sample_ = 1;
  GreyCurve curve_;
};

// Standard deviation of a loop's greys over all frames and weights.
double loopDeviation(const std::vector<std::vector<float>>& frames, std::span<const float> weights);

}  // namespace echocine::compare
