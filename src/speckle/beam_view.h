#pragma once
// Where a place of the probe frame lies among the scan lines, and what a beam can see of a ball.

#include <numbers>

#include "core/lanes.h"
#include "core/rough_angle.h"
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

class BeamView {
 public:
  BeamView(const Probe& probe, const PointSpread& spread);

  // Lines lie at whole numbers; depths are path lengths. Directions to 1e-5 rad.
  struct Place8 {
    Floats8 line, path_m;
  };
  Place8 placeOf(Floats8 x, Floats8 z) const {
    if (linear_) return {(x - z * tangent_ - first_) * per_pitch_, z * per_cosine_};
    const Floats8 r = root(x * x + z * z);
    return {(angleOf(x, z) - first_) * per_pitch_, r - face_radius_m_};
  }

  // May a beam reach some of it? True where in doubt.
  bool sees(const Extent& extent) const;

  // Lateral sigma of the amplitude's bell at a path length, in lines.
  double lateralLines(double path_m) const;

 private:
  double cutSquared(double path_m) const;
  static Floats8 root(Floats8 a) {
    Floats8 out;
    for (std::size_t i = 0; i < kFloatLanes; ++i) out[i] = std::sqrt(a[i]);
    return out;
  }
  // atan2(x, z) for z >= 0.
  static Floats8 angleOf(Floats8 x, Floats8 z) {
    const Floats8 ax = x < 0 ? -x : x, large = ax > z ? ax : z, small = ax > z ? z : ax;
    const Floats8 q = small / (large + 1e-30f), q2 = q * q;
    const Floats8 near =  // roughArctangent() in single precision
        q * (0.9998660f +
             q2 * (-0.3302995f + q2 * (0.1801410f + q2 * (-0.0851330f + q2 * 0.0208351f))));
    const Floats8 angle = ax > z ? static_cast<float>(std::numbers::pi / 2) - near : near;
    return x < 0 ? -angle : angle;
  }

  Probe probe_;
  PointSpread spread_;
  bool linear_ = false;
  double diffraction_ = 0;  // part of w_e over the path length
  double pitch_ = 0;        // between lines: rad, or m of a linear probe
  float first_ = 0, per_pitch_ = 0, face_radius_m_ = 0, tangent_ = 0, per_cosine_ = 1;
};

}  // namespace echocine
