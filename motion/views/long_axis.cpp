#include "motion/views/long_axis.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "motion/views/point_cloud.h"

namespace echocine {

namespace {

constexpr double kApexShare = 0.03;  // of the length; our choice
// Share of the length that counts as the base's or the apex's end; the middle of an end is half as
// far inside. The error of the axis is 2 to 11 deg over four hearts. Our choice.
constexpr double kCapShare = 0.20;

// The points between two heights along an axis.
std::vector<Vec3d> between(std::span<const Vec3d> points, Vec3d axis, double low, double high) {
  std::vector<Vec3d> found;
  for (const Vec3d p : points)
    if (dot(p, axis) >= low && dot(p, axis) <= high) found.push_back(p);
  return found;
}

// Mean distance from their middle across the axis.
double widthOf(std::span<const Vec3d> points, Vec3d axis) {
  const Vec3d middle = middleOf(points);
  double sum = 0;
  for (const Vec3d p : points) sum += length(cross(p - middle, axis));
  return sum / static_cast<double>(points.size());
}

}  // namespace

Vec3d principalAxis(std::span<const Vec3d> points, Vec3d across) {
  const Vec3d middle = middleOf(points);
  const auto kept = [&](Vec3d v) { return v - dot(v, across) * across; };
  // Starts from the direction of the farthest point, so that it turns along with the points.
  Vec3d axis{};
  for (const Vec3d p : points) {
    const Vec3d d = kept(p - middle);
    if (dot(d, d) > dot(axis, axis)) axis = d;
  }
  if (dot(axis, axis) == 0) return {0, 0, 1};
  axis = normalised(axis);
  for (int step = 0; step < 200; ++step) {
    Vec3d next{};
    for (const Vec3d p : points) next = next + dot(kept(p - middle), axis) * kept(p - middle);
    if (dot(next, next) == 0) break;
    next = normalised(next);
    const bool settled = length(next - axis) < 1e-13;
    axis = next;
    if (settled) break;
  }
  return axis;
}

VentricleAxis axisFromBase(std::span<const Vec3d> cavity, Vec3d base) {
  double farthest = 0;
  for (const Vec3d p : cavity) farthest = std::max(farthest, length(p - base));
  std::vector<Vec3d> tip;
  for (const Vec3d p : cavity)
    if (length(p - base) >= (1 - kApexShare) * farthest) tip.push_back(p);
  return {base, base + farthest * normalised(middleOf(tip) - base)};
}

VentricleAxis axisOfCavity(std::span<const Vec3d> cavity, Vec3d towards_base) {
  const Vec3d axis = principalAxis(cavity);
  double low = dot(cavity.front(), axis), high = low;
  for (const Vec3d p : cavity) {
    low = std::min(low, dot(p, axis));
    high = std::max(high, dot(p, axis));
  }
  const double cap = kCapShare * (high - low);
  const std::vector<Vec3d> first = between(cavity, axis, low, low + cap),
                           last = between(cavity, axis, high - cap, high);
  const double side = dot(towards_base, axis);
  const bool base_last = side != 0 ? side > 0 : widthOf(last, axis) > widthOf(first, axis);
  const Vec3d outward = base_last ? axis : -axis;
  return axisFromBase(cavity, middleOf(base_last ? last : first) + 0.25 * cap * outward);
}

}  // namespace echocine
