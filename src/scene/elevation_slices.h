#pragma once
// The beam across the imaging plane by a few slices: a quadrature in place of many rays.
//
// At the path length z the two-way profile of the lens is the bell N(0, sigma(z)^2) in y, sigma =
// w_e / sqrt(8 ln 4) (elevationBeamWidth()). Slice k is the surface y = u_k sigma(z), and
//
//   mean over y of f(y, z) = sum over k of q_k f(u_k sigma(z), z)                            (1)
//
// with u_k, q_k of Gauss and Hermite: exact where f is a polynomial in y of degree up to 2 n - 1.
// Of a step, as a wall's edge is, n slices make n smaller ones. The widest slices count for little,
// yet on a logarithmic scale an edge's foot is theirs: 19 dB under the wall for five slices.

#include <algorithm>
#include <cmath>
#include <span>

#include "scene/scene.h"

namespace echocine {

inline constexpr int kMostElevationSlices = 5;

struct ElevationNode {
  double place;   // u, in deviations of the beam
  double weight;  // q; they add up to 1
};

// The imaging plane first, then the others in pairs. Precondition: 1, 3 or 5.
std::span<const ElevationNode> elevationNodes(int slices);

// sigma by the path length, m: elevationBeamWidth() with what does not change worked out before.
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

// How far the scene's slices lie from the imaging plane at most, m; 0 of one slice.
double elevationReach(const Scene& scene);

}  // namespace echocine
