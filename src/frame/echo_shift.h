#pragma once
// How far refraction moves what a picture shows: the honest ground for leaving it out.
//
// Rule. A frame's lines, in 8 groups side by side, and its depth, in 8 bands, make 64 fields. In a
// field each line counts once, with the farthest shift of its echoes there, in beam widths; the
// field's shift is the one that a quarter of its lines exceeds. So a few rays that graze are no
// reason to bend all, echoes that stay do not hide others that move, and neither the number of
// lines nor that of layers has a part in it. What attenuation has taken 120 dB from no scanner
// receives: there a line ends. One that ends elsewhere when it bends is shifted by that distance in
// between. The frame's shift is the largest field's, that of a loop the largest of its frames.
// Fields, quarter and tolerance are our choice.

#include "geometry/frame_geometry.h"
#include "scene/scene.h"
#include "trace/trace_settings.h"

namespace echocine {

struct EchoShift {
  double metres = 0;
  double beam_widths = 0;  // the same in widths of the beam
  double depth_m = 0;      // of the field's middle
  double phase = 0;        // of the beat, [0, 1)
};

inline bool operator<(const EchoShift& a, const EchoShift& b) {
  return a.beam_widths < b.beam_widths;
}

class EchoShiftMeter {
 public:
  // Rays out of the imaging plane are asked too where the plan traces them.
  EchoShiftMeter(const Scene& scene, const EffectPlan& plan);

  // The shift of one frame; nothing met gives 0.
  EchoShift measure(const FrameGeometry& geometry, double phase) const;

 private:
  struct Fields;
  void measureRays(const FrameGeometry& geometry, double elevation, Fields& fields) const;
  double resolution(double depth_m) const;
  double elevationResolution(double depth_m) const;

  Scene scene_;  // with lines of the rule's own
  EffectPlan plan_;
};

}  // namespace echocine
