#include "motion/views/point_cloud.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace echocine {

Vec3d middleOf(std::span<const Vec3d> points) {
  Vec3d sum{};
  for (const Vec3d p : points) sum = sum + p;
  return 1 / static_cast<double>(points.size()) * sum;
}

std::vector<Vec3d> thinned(std::vector<Vec3d> points, std::size_t most) {
  if (points.size() <= most) return points;
  std::vector<Vec3d> few;
  for (std::size_t i = 0; i < most; ++i) few.push_back(points[i * points.size() / most]);
  return few;
}

Contact contactOf(std::span<const Vec3d> a, std::span<const Vec3d> b, double margin) {
  std::vector<double> apart;
  for (const Vec3d p : a) {
    double least = std::numeric_limits<double>::max();
    for (const Vec3d q : b) least = std::min(least, dot(p - q, p - q));
    apart.push_back(std::sqrt(least));
  }
  Contact contact{{}, *std::min_element(apart.begin(), apart.end())};
  std::vector<Vec3d> near;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (apart[i] <= contact.gap + margin) near.push_back(a[i]);
  contact.middle = middleOf(near);
  return contact;
}

}  // namespace echocine
