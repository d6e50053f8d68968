#pragma once
// The beam across the imaging plane as a few slices: a quadrature instead of many rays.
//
// At the path length z the two-way profile of the lens is the Gaussian N(0, sigma(z)^2) in y, with
// sigma = w_e / sqrt(8 ln 4) (elevationBeamWidth()). Slice k is the surface y = u_k sigma(z), and
//
//   mean over y of f(y, z) = sum over k of q_k f(u_k sigma(z), z)                            (1)
//
// with u_k, q_k of Gauss-Hermite quadrature: exact if f is a polynomial in y of degree up to 2 n -
// 1. A step, such as the edge of a wall, becomes n smaller steps. The outermost slices have small
// weights but are visible on a logarithmic scale: the foot of an edge is 19 dB below the wall for
// five slices.

#include <algorithm>
#include <cmath>
#include <span>

#include "scene/scene.h"

namespace echocine {

inline constexpr int kMostElevationSlices = 5;

struct ElevationNode {
  double place;   // u, in standard deviations of the beam
  double weight;  // q; the weights sum to 1
};

// The imaging plane first, then pairs. Precondition: 1, 3 or 5.
std::span<const ElevationNode> elevationNodes(int slices);

// sigma by path length, m: elevationBeamWidth() with precomputed constants.
class ElevationBell {
 public:
  explicit ElevationBell(const Probe& probe);
  double deviation(double depth_m) const {
    const double z = std::max(depth_m, 0.0), diffracted = slope_ * z,
                 convergent = lens_m_ * (1 - z * per_focus_);
    return std::sqrt(diffracted * diffracted + convergent * convergent);
  }

 private:
  double slope_, lens_m_, per_focus_;
};

// Largest distance of the scene's slices from the imaging plane, m; 0 for one slice.
double elevationReach(const Scene& scene);

}  // namespace echocine
