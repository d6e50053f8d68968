#pragma once
// The volume within a smooth surface, from its points on a sphere mesh.

#include "motion/heart/control_mesh.h"

namespace echocine::heart {

// Facets cut corners: half a per cent of a chamber's volume here. Their error falls with the square
// of the edge length, so twice as fine a mesh tells it (Richardson); once, since chambers keep
// their kind of shape over the beat.
class VolumeGauge {
 public:
  template <typename PointOf>
  VolumeGauge(int frequency, const PointOf& pointOf) : sphere_(geodesicSphere(frequency)) {
    const double coarse = facets(sphere_, pointOf);
    const double fine = facets(geodesicSphere(2 * frequency), pointOf);
    gain_ = (coarse + (fine - coarse) * 4 / 3) / coarse;
  }

  template <typename PointOf>
  double operator()(const PointOf& pointOf) const {
    return gain_ * facets(sphere_, pointOf);
  }

 private:
  template <typename PointOf>
  static double facets(const SphereMesh& sphere, const PointOf& pointOf) {
    return volumeOf(pointsOn(sphere, pointOf), sphere.faces);
  }

  SphereMesh sphere_;
  double gain_ = 1;
};

}  // namespace echocine::heart
