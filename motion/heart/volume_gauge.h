#pragma once
// Volume within a smooth surface, from its points on a sphere mesh.

#include "motion/heart/control_mesh.h"

namespace echocine::heart {

// Facets underestimate a chamber's volume, by half a per cent here. The error falls with the square
// of the edge length, so a mesh of half the edge length determines it (Richardson). It is computed
// once, because chambers keep their shape over the beat.
class VolumeGauge {
 public:
  // From the surface's points for the directions of geodesicSphere(frequency) and of one twice as
  // fine.
  VolumeGauge(int frequency, const std::vector<Vec3d>& coarse_points,
              const std::vector<Vec3d>& fine_points)
      : faces_(&geodesicSphere(frequency).faces) {
    const double coarse = volumeOf(coarse_points, *faces_);
    const double fine = volumeOf(fine_points, geodesicSphere(2 * frequency).faces);
    gain_ = (coarse + (fine - coarse) * 4 / 3) / coarse;
  }

  template <typename PointOf>
  VolumeGauge(int frequency, const PointOf& pointOf)
      : VolumeGauge(frequency, pointsOn(geodesicSphere(frequency), pointOf),
                    pointsOn(geodesicSphere(2 * frequency), pointOf)) {}

  // Volume from points for the directions of geodesicSphere(frequency).
  double operator()(const std::vector<Vec3d>& points) const {
    return gain_ * volumeOf(points, *faces_);
  }

 private:
  const std::vector<Face>* faces_;
  double gain_ = 1;
};

}  // namespace echocine::heart
