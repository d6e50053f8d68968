#pragma once
// The scanner's signal processing, the same in every frame of a loop:
// time gain -> beam width -> log compression -> scan conversion -> grey map.
// Spread is the tracer's part (it knows which intensity was scattered), by the signal_terms of its
// request.

#include <optional>
#include <vector>

#include "scene/effect_plan.h"
#include "signal/beam_width.h"
#include "signal/scan_conversion.h"
#include "trace/polar_frame.h"

namespace echocine {

class SignalChain {
 public:
  SignalChain(const Scene& scene, const EffectPlan& plan);

  const PictureGeometry& geometry() const { return geometry_; }

  // Time gain and beam width, in place on frame.signal: intensities as they are compressed.
  void process(PolarFrame& frame) const;

  // Log compression in place on frame.signal: from processed intensities to grey 0..1 in beam
  // space.
  void compress(PolarFrame& frame, double reference_intensity) const;

  // Scan conversion and grey map.
  void picture(const PolarFrame& frame, GreyImage& image) const {
    converter_.convert(frame.signal, image);
  }
  // Scan conversion alone: grey 0..1, -1 outside the sector.
  void picture(const PolarFrame& frame, std::vector<float>& grey) const {
    converter_.convert(frame.signal, grey);
  }

 private:
  SignalSettings settings_;
  std::vector<float> gains_;  // of a table or the mean; empty: none
  std::optional<BeamAverage> beam_;
  PictureGeometry geometry_;
  ScanConverter converter_;
};

}  // namespace echocine
