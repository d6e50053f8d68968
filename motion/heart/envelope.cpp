#include "motion/heart/envelope.h"

#include <algorithm>
#include <cmath>

#include "motion/heart/units.h"

namespace echocine::heart {

std::vector<Vec3d> envelopeOf(std::span<const Vec3d> points, Vec3d centre, double gap_m,
                              const SphereMesh& sphere) {
  // The farthest point within a cone; then the mean over a cone as wide, which is smooth and, being
  // a mean of maxima over cones that hold the point itself, no nearer than the point.
  const double cos_cone = std::cos(13 * kDegree), cos_mean = std::cos(12.9 * kDegree);
  const auto& directions = sphere.directions;
  std::vector<double> farthest(directions.size(), 0);
  for (const Vec3d point : points) {
    const Vec3d from = point - centre;
    const double distance = length(from);
    for (std::size_t d = 0; d < directions.size(); ++d)
      if (dot(from, directions[d]) >= cos_cone * distance)
        farthest[d] = std::max(farthest[d], distance);
  }
  std::vector<Vec3d> surface;
  for (std::size_t d = 0; d < directions.size(); ++d) {
    double sum = 0, weights = 0;
    for (std::size_t e = 0; e < directions.size(); ++e) {
      const double cosine = dot(directions[d], directions[e]);
      if (cosine < cos_mean) continue;
      const double weight = (cosine - cos_mean) / (1 - cos_mean);
      sum += weight * farthest[e];
      weights += weight;
    }
    surface.push_back(centre + (sum / weights + gap_m) * directions[d]);
  }
  return surface;
}

}  // namespace echocine::heart
