#pragma once
// Displacement of visible echoes by refraction: the criterion for omitting it.
//
// Rule. A frame's lines, in 8 adjacent groups, and its depth, in 8 bands, form 64 fields. In a
// field each line counts once, with the largest shift of its echoes there, in beam widths. The
// field's shift is the one exceeded by a quarter of its lines. A few grazing rays thus do not
// enable refraction, static echoes do not hide moving ones, and the numbers of lines and layers
// have no influence. A line ends where attenuation reaches 120 dB, because no scanner receives
// echoes beyond. A line that ends elsewhere with refraction is shifted by that distance in between.
// The frame's shift is the largest of its fields, the loop's shift the largest of its frames.
// Fields, quarter and tolerance are our choice.

#include "geometry/frame_geometry.h"
#include "scene/scene.h"
#include "trace/trace_settings.h"

namespace echocine {

struct EchoShift {
  double metres = 0;
  double beam_widths = 0;  // the same in beam widths
  double depth_m = 0;      // centre of the field
  double phase = 0;        // of the beat, [0, 1)
};

inline bool operator<(const EchoShift& a, const EchoShift& b) {
  return a.beam_widths < b.beam_widths;
}

class EchoShiftMeter {
 public:
  // Includes rays out of the imaging plane if the plan traces them.
  EchoShiftMeter(const Scene& scene, const EffectPlan& plan);

  // The shift of one frame; 0 without interfaces.
  EchoShift measure(const FrameGeometry& geometry, double phase) const;

 private:
  struct Fields;
  void measureRays(const FrameGeometry& geometry, double elevation, Fields& fields) const;
  double resolution(double depth_m) const;
  double elevationResolution(double depth_m) const;

  Scene scene_;  // with the rule's own lines
  EffectPlan plan_;
};

}  // namespace echocine
