#pragma once
// Position of a place of the probe frame among the scan lines, and visibility of a ball to a beam.

#include "core/beam_plane.h"
#include "core/lanes.h"
#include "scene/probe.h"
#include "speckle/material.h"
#include "speckle/point_spread.h"

namespace echocine {

// Bounds of a piece of tissue: a disc in the imaging plane, and its range across it.
struct Extent {
  double x_m = 0, z_m = 0, radius_m = 0;
  double low_y_m = 0, high_y_m = 0;
};

// Bounds of a trilinear cube: it lies in the convex hull of its corners.
Extent extentOf(const CubeCorners& corners, double margin_m = 0);

// Corners of a cube: lines and samples by the index of the one whose cell begins there, and
// distances from the imaging plane relative to the elevation cut.
struct BeamCube {
  Floats8 line, sample, across;
};

class BeamView {
 public:
  BeamView(const Probe& probe, const PointSpread& spread);

  // A cube's corners in beam space. Places between them are trilinear there. The error is edge^2 /
  // 8 r; it moves with the scatterer and so does not affect its motion.
  BeamCube cubeOf(const CubeCorners& corners) const;

  // Can the beams of these lines reach a part of it? Exact, because a trilinear cube lies between
  // its corners.
  bool sees(const BeamCube& cube, LineRange lines) const;
  bool sees(const BeamCube& cube) const { return sees(cube, {0, probe_.lines}); }

  // Can a beam reach a part of it? True if undecided.
  bool sees(const Extent& extent) const;

  // Lateral sigma of the amplitude's Gaussian at a path length, in lines.
  double lateralLines(double path_m) const;

 private:
  double cutSquared(double path_m) const;
  Probe probe_;
  PointSpread spread_;
  bool linear_ = false, full_turn_ = false;
  double diffraction_ = 0;  // part of w_e proportional to the path length
  double pitch_ = 0;        // between lines: rad, or m of a linear probe
  float first_ = 0, per_pitch_ = 0, face_radius_m_ = 0, tangent_ = 0, per_cosine_ = 1;
  float samples_ = 0, min_depth_m_ = 0, per_spacing_ = 0;
  float across_ = 0, lens_ = 0, per_focus_ = 0;  // the cut: sqrt of the sum of squares
};

}  // namespace echocine
