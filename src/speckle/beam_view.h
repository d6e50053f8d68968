#pragma once
// Where a place of the probe frame lies among the scan lines, and what a beam can see of a ball.

#include "core/beam_plane.h"
#include "core/lanes.h"
#include "scene/probe.h"
#include "speckle/material.h"
#include "speckle/point_spread.h"

namespace echocine {

// What holds tissue: a disc in the imaging plane, and how near and far across it.
struct Extent {
  double x_m = 0, z_m = 0, radius_m = 0;
  double low_y_m = 0, high_y_m = 0;
};

// Of what is trilinear within a cube: it lies in the hull of its corners.
Extent extentOf(const CubeCorners& corners, double margin_m = 0);

// Corners of a cube: lines and samples by the number of the one whose share begins there, and
// places across the imaging plane in parts of the distance at which the elevation is cut.
struct BeamCube {
  Floats8 line, sample, across;
};

class BeamView {
 public:
  BeamView(const Probe& probe, const PointSpread& spread);

  // A cube's corners in beam space. Between them places are taken as trilinear there: off by
  // edge^2 / 8 r, which stays with a scatterer as it moves and so never shows in its motion.
  BeamCube cubeOf(const CubeCorners& corners) const;

  // May one of these lines' beams reach some of it? Exact, since what is trilinear lies between its
  // corners.
  bool sees(const BeamCube& cube, LineRange lines) const;
  bool sees(const BeamCube& cube) const { return sees(cube, {0, probe_.lines}); }

  // May a beam reach some of it? True where in doubt.
  bool sees(const Extent& extent) const;

  // Lateral sigma of the amplitude's bell at a path length, in lines.
  double lateralLines(double path_m) const;

 private:
  double cutSquared(double path_m) const;
  Probe probe_;
  PointSpread spread_;
  bool linear_ = false;
  double diffraction_ = 0;  // part of w_e over the path length
  double pitch_ = 0;        // between lines: rad, or m of a linear probe
  float first_ = 0, per_pitch_ = 0, face_radius_m_ = 0, tangent_ = 0, per_cosine_ = 1;
  float samples_ = 0, min_depth_m_ = 0, per_spacing_ = 0;
  float across_ = 0, lens_ = 0, per_focus_ = 0;  // what is cut: sqrt of the squares' sum
};

}  // namespace echocine
