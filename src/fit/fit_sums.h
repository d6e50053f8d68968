#pragma once
// Shared by the terms and maps of a fit: places under a pose, edges along normals, sums of grey
// levels.

#include <cmath>
#include <span>

#include "core/lanes.h"
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
        turn_s_(std::sin(p.turn_rad)),
        scale_(std::hypot(c_, s_)) {}
  // Positive angles rotate depth towards lateral, like Placement's rotation.
  void place(double x, double z, double& rx, double& rz) const {
    const double dz = z - middle_;
    rx = x_ + c_ * x + s_ * dz;
    rz = middle_ + z_ - s_ * x + c_ * dz;
  }
  // Eight places, in the precision of a float.
  void place(Floats8& x, Floats8& z) const {
    const auto middle = static_cast<float>(middle_), c = static_cast<float>(c_),
               s = static_cast<float>(s_);
    const Floats8 dz = z - middle, from = x;
    x = static_cast<float>(x_) + c * from + s * dz;
    z = static_cast<float>(middle_ + z_) - s * from + c * dz;
  }
  void turn(double x, double z, double& rx, double& rz) const {
    rx = turn_c_ * x + turn_s_ * z;
    rz = -turn_s_ * x + turn_c_ * z;
  }
  double scale() const { return scale_; }

 private:
  double middle_, x_, z_, c_, s_, turn_c_, turn_s_, scale_;
};

// p(s) of Eq. 4 as its first two moments, and its certainty.
struct EdgeProfile {
  double mean_m = 0, square = 1.0 / 3;  // mean of s, m; mean of (s/S)^2
  double visible = 0;                   // visibility of the place itself
  double p[kProfileSteps] = {};

  double certainty() const;  // 1 - entropy of p / entropy of an even p
};

// Displacement into the blood at which a boundary is visible, at its place in the real plane: Eq.
// 9, and BoundaryPoint::inside_m in a loop with speckle. 0 for other boundaries.
double seenBeside(const BoundaryPoint& p, const echo::EchoStack& real, const PoseMapping& map,
                  double x, double z, double nx, double nz);

// A boundary point under a pose, and the edge where it is visible.
struct PlacedEdge {
  double x = 0, z = 0, nx = 0, nz = 0;
  double beside = 0;  // of seenBeside()
  EdgeProfile edge;
};
// Boundary points under a pose, up to eight in little more than the time of two.
void placedEdges(std::span<const BoundaryPoint> points, const echo::EchoInstant& at,
                 const PoseMapping& map, PlacedEdge out[kFloatLanes]);
// Calls use(i, placed) for all points, in order.
template <typename Use>
void forEachPlaced(std::span<const BoundaryPoint> points, const echo::EchoInstant& at,
                   const PoseMapping& map, const Use& use) {
  PlacedEdge placed[kFloatLanes];
  for (std::size_t first = 0; first < points.size(); first += kFloatLanes) {
    const auto some = points.subspan(first, std::min(kFloatLanes, points.size() - first));
    placedEdges(some, at, map, placed);
    for (std::size_t i = 0; i < some.size(); ++i) use(first + i, placed[i]);
  }
}

// u - v|^2 and |u|^2 + |v|^2 of Eq. 5; weight 0 without tracking.
struct MotionPair {
  double apart = 0, together = 0, weight = 0;
  double dx = 0, dz = 0;  // u - v
};
MotionPair motionOf(const BoundaryPoint& p, const echo::EchoInstant& at, const PoseMapping& map,
                    double x, double z, double nx, double nz);

// Sums of Eq. 3.
struct RegionSums {
  TissueGreys greys;
  double seen = 0, all = 0;  // areas
};

// Adds cells of a frame; those without an area are skipped.
void addCells(std::span<const TissueCell> cells, const echo::EchoInstant& at,
              const PoseMapping& map, RegionSums& sums);
// Number of cells at the largest depth per square metre; a cell there has an area of 1.
double cellsPerArea(const ModelLoop& model);

// The instant of a model's frame in the beat.
echo::BeatPlace placeOf(const ModelLoop& model, std::size_t frame, const FitPose& pose,
                        const echo::EchoStack& real);

}  // namespace echocine::fit
