#pragma once
// The sac around the heart.

#include <span>
#include <vector>

#include "motion/heart/control_mesh.h"

namespace echocine::heart {

// A smooth star-shaped surface around `centre` that encloses given points.
class Envelope {
 public:
  static constexpr int kFrequency = 9;  // of its geodesicSphere

  Envelope(std::span<const Vec3d> points, Vec3d centre);

  // Points, one per direction of the sphere mesh, of the surface `gap_m` outside.
  std::vector<Vec3d> points(double gap_m) const;

 private:
  Vec3d centre_;
  std::vector<double> reach_m_;  // by direction
};

}  // namespace echocine::heart
