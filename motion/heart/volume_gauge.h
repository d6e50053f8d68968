#pragma once
// The volume within a smooth surface, from its points on a sphere mesh.

#include "motion/heart/control_mesh.h"

namespace echocine::heart {

// Facets cut corners: half a per cent of a chamber's volume here. Their error falls with the square
// of the edge length, so twice as fine a mesh tells it (Richardson); once, since chambers keep
// their kind of shape over the beat.
class VolumeGauge {
 public:
  // By the surface's points for the directions of geodesicSphere(frequency) and of one twice as
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

  // Of points for the directions of geodesicSphere(frequency).
  double operator()(const std::vector<Vec3d>& points) const {
    return gain_ * volumeOf(points, *faces_);
  }

 private:
  const std::vector<Face>* faces_;
  double gain_ = 1;
};

}  // namespace echocine::heart
