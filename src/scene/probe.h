#pragma once
// A scanner's probe. Probe frame: x lateral, y elevation, z depth; the imaging
// plane is y = 0 and the origin is the apex.

#include "core/vec3.h"
#include "scene/probe_kind.h"

namespace echocine {

// The sound speed by which a scanner converts echo times to depths: the average of soft tissue.
inline constexpr double kScannerSpeed = 1540;  // m/s

// Weights of an aperture's elements.
enum class Apodization { uniform, hann, hamming };

struct Probe {
  ProbeKind kind = ProbeKind::phased;
  // World pose. The apex is the common point of the scan lines: the transducer for a phased array,
  // the centre of curvature behind the face for a curvilinear one, the axis of the catheter for a
  // radial one, the centre of the face for a linear one.
  Pose pose;
  // The outermost lines, from z towards x; for a radial probe -pi and pi, half a cell beyond its
  // outermost lines.
  double first_angle_rad = 0, last_angle_rad = 0;
  double face_radius_m = 0;                      // curvilinear, radial: apex to face; others 0
  double first_offset_m = 0, last_offset_m = 0;  // linear: lateral start of the outermost lines
  double min_depth_m = 0, max_depth_m = 0;       // path lengths from the face
  double frequency_hz = 0;
  double aperture_m = 0;  // active lateral aperture of a beam
  double focus_m = 0;     // depth of the focus
  // For the sampled profile: apodization of the receiving aperture; and the two-way -6 dB bandwidth
  // over the centre frequency, 74 % for the array P4-2v (Verasonics).
  Apodization receive_apodization = Apodization::uniform;
  double bandwidth = 0.74;
  // The fixed lens across the imaging plane: our choice for an adult cardiac probe.
  double elevation_aperture_m = 0.013;
  double elevation_focus_m = 0.08;
  int lines = 0, samples = 0;

  bool isFan() const { return layoutOf(kind).fan; }  // otherwise its lines are parallel
  bool isFullTurn() const { return layoutOf(kind).full_turn; }
  bool isSector() const { return isFan() && !isFullTurn(); }
  double sampleSpacing() const { return (max_depth_m - min_depth_m) / samples; }
  double middleDepth() const { return 0.5 * (min_depth_m + max_depth_m); }
};

}  // namespace echocine
