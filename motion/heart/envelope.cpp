#include "motion/heart/envelope.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "motion/heart/heart_units.h"

namespace echocine::heart {
namespace {

const std::vector<Vec3d>& sacDirections() {
  return geodesicSphere(Envelope::kFrequency).directions;
}

// The farthest point within a cone about each direction.
std::vector<double> farthestIn(std::span<const Vec3d> points, Vec3d centre) {
  static const std::array<std::vector<double>, 3> coordinates = [] {  // one by one: they vectorise
    std::array<std::vector<double>, 3> made;
    for (const Vec3d d : sacDirections()) {
      made[0].push_back(d.x);
      made[1].push_back(d.y);
      made[2].push_back(d.z);
    }
    return made;
  }();
  const double cos_cone = std::cos(13 * kDegree);
  const std::size_t count = sacDirections().size();
  const double *const x = coordinates[0].data(), *const y = coordinates[1].data(),
                      *const z = coordinates[2].data();
  std::vector<double> farthest_m(count, 0);
  double* const farthest = farthest_m.data();
  for (const Vec3d point : points) {
    const Vec3d from = point - centre;
    const double distance = length(from), least = cos_cone * distance;
    for (std::size_t d = 0; d < count; ++d) {
      const double along = from.x * x[d] + from.y * y[d] + from.z * z[d];
      const double reached = along >= least ? distance : 0;
      farthest[d] = farthest[d] < reached ? reached : farthest[d];
    }
  }
  return farthest_m;
}

// The directions in the mean around each one, with their weights.
struct Share {
  std::size_t direction;
  double weight;
};
const std::vector<std::vector<Share>>& sharesAbout() {
  static const std::vector<std::vector<Share>> shares = [] {
    const double cos_mean = std::cos(12.9 * kDegree);
    std::vector<std::vector<Share>> made(sacDirections().size());
    for (std::size_t d = 0; d < made.size(); ++d)
      for (std::size_t e = 0; e < made.size(); ++e) {
        const double cosine = dot(sacDirections()[d], sacDirections()[e]);
        if (cosine >= cos_mean) made[d].push_back({e, (cosine - cos_mean) / (1 - cos_mean)});
      }
    return made;
  }();
  return shares;
}

}  // namespace

// The farthest point within a cone, then the mean over a cone of equal width. The result is smooth.
// It is not closer than the point itself, because it is a mean of maxima over cones that contain
// the point.
Envelope::Envelope(std::span<const Vec3d> points, Vec3d centre) : centre_(centre) {
  const std::vector<double> farthest_m = farthestIn(points, centre);
  for (const std::vector<Share>& shares : sharesAbout()) {
    double sum = 0, weights = 0;
    for (const auto& [direction, weight] : shares) {
      sum += weight * farthest_m[direction];
      weights += weight;
    }
    reach_m_.push_back(sum / weights);
  }
}

std::vector<Vec3d> Envelope::points(double gap_m) const {
  std::vector<Vec3d> surface;
  surface.reserve(reach_m_.size());
  for (std::size_t d = 0; d < reach_m_.size(); ++d)
    surface.push_back(centre_ + (reach_m_[d] + gap_m) * sacDirections()[d]);
  return surface;
}

}  // namespace echocine::heart
