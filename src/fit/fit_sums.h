#pragma once
// What terms and maps of a fit share: places under a pose, edges along normals, sums of greys.

#include <cmath>

#include "fit/fit_terms.h"
#include "fit/tissue_greys.h"

namespace echocine::fit {

inline constexpr int kProfileSteps = 9;          // along a normal
inline constexpr double kProfileReach_m = 8e-3;  // S of Eq. 4; our choice

// A pose with its sine and cosine.
class PoseMapping {
 public:
  PoseMapping(const FitPose& p, double far_m)
      : middle_(far_m / 2),
        x_(p.shift_x_m),
        z_(p.shift_z_m),
        c_(p.scale * std::cos(p.turn_rad)),
        s_(p.scale * std::sin(p.turn_rad)),
        turn_c_(std::cos(p.turn_rad)),
        turn_s_(std::sin(p.turn_rad)) {}
  // Positive turns lead from depth towards lateral, as Placement's rotation does.
  void place(double x, double z, double& rx, double& rz) const {
    const double dz = z - middle_;
    rx = x_ + c_ * x + s_ * dz;
    rz = middle_ + z_ - s_ * x + c_ * dz;
  }
  void turn(double x, double z, double& rx, double& rz) const {
    rx = turn_c_ * x + turn_s_ * z;
    rz = -turn_s_ * x + turn_c_ * z;
  }
  double scale() const { return std::hypot(c_, s_); }

 private:
  double middle_, x_, z_, c_, s_, turn_c_, turn_s_;
};

// p(s) of Eq. 4 as its first two moments, and how far from even it is.
struct EdgeProfile {
  double mean_m = 0, square = 1.0 / 3;  // of s; of (s/S)^2
  double visible = 0;                   // of the place itself
  double p[kProfileSteps] = {};

  double certainty() const;  // 1 - entropy of p over that of an even one
};

// Along a unit normal at a place of the real plane.
EdgeProfile edgeProfileAt(const echo::EchoStack& real, const echo::BeatPlace& at, double x,
                          double z, double nx, double nz, bool of_blood);

// How far into blood a boundary is seen: Eq. 9.
double seenBeside(const echo::EchoStack& real, double x, double z, double nx, double nz);

// |u - v|^2 and |u|^2 + |v|^2 of Eq. 5; no weight where nothing is tracked.
struct MotionPair {
  double apart = 0, together = 0, weight = 0;
};
MotionPair motionOf(const BoundaryPoint& p, const echo::EchoStack& real, const echo::BeatPlace& at,
                    const PoseMapping& map, double x, double z, double nx, double nz);

// Of Eq. 3.
struct RegionSums {
  TissueGreys greys;
  double seen = 0, all = 0;  // areas
};

// The cells of a frame.
void addCells(const ModelLoop& model, const ModelFrame& frame, const echo::EchoStack& real,
              const echo::BeatPlace& at, const PoseMapping& map, int stride, RegionSums& sums);
// What lies between a boundary of blood and where it is seen: it looks like what is beside blood.
void addStrip(const BoundaryPoint& p, const echo::EchoStack& real, const echo::BeatPlace& at,
              double x, double z, double nx, double nz, double beside, double cells_per_m2,
              RegionSums& sums);
// Cells at the largest depth, whose area counts as 1, to the square metre, where every
// `stride.cell`-th and every `stride.piece`-th piece is looked at.
double cellsPerArea(const ModelLoop& model, const FitStride& stride);

// The instant of a model's frame.
echo::BeatPlace placeOf(const ModelLoop& model, std::size_t frame, const FitPose& pose,
                        const echo::EchoStack& real);

}  // namespace echocine::fit
