#include "motion/views/long_axis.h"

#include <algorithm>
#include <cmath>

namespace echocine {

namespace {

constexpr double kApexShare = 0.03;  // of the length; our choice
// Share of the length that counts as the base's or the apex's end; the middle of an end is half as
// far inside. The error of the axis is 2 to 11 deg over four hearts. Our choice.
constexpr double kCapShare = 0.20;

// The part between two heights along an axis.
Facets between(std::span<const Facet> surface, Vec3d axis, double low, double high) {
  const Facets over = partAbove(
      surface, [&](Vec3d p) { return dot(p, axis); }, low);
  return partAbove(
      over, [&](Vec3d p) { return -dot(p, axis); }, -high);
}

// Mean distance from the middle across the axis, by area.
double widthOf(std::span<const Facet> surface, Vec3d axis) {
  const Vec3d middle = middleOf(surface);
  double sum = 0, area = 0;
  for (const Facet& f : surface) {
    const double of_this = areaOf(f);
    sum += of_this * length(cross((1.0 / 3) * (f[0] + f[1] + f[2]) - middle, axis));
    area += of_this;
  }
  return area > 0 ? sum / area : 0;
}

}  // namespace

Vec3d principalAxis(std::span<const Facet> surface, Vec3d across) {
  const Vec3d middle = middleOf(surface);
  const auto kept = [&](Vec3d v) { return v - dot(v, across) * across; };
  // Starts from the direction of the farthest point, so that it turns along with the surface.
  Vec3d axis{};
  for (const Facet& f : surface)
    for (const Vec3d p : f) {
      const Vec3d d = kept(p - middle);
      if (dot(d, d) > dot(axis, axis)) axis = d;
    }
  if (dot(axis, axis) == 0) return {0, 0, 1};
  axis = normalised(axis);
  const std::array<Vec3d, 3> rows = momentsAbout(surface, middle);
  for (int step = 0; step < 200; ++step) {
    const Vec3d next = kept({dot(rows[0], axis), dot(rows[1], axis), dot(rows[2], axis)});
    if (dot(next, next) == 0) break;
    const Vec3d unit = normalised(next);
    const bool settled = length(unit - axis) < 1e-13;
    axis = unit;
    if (settled) break;
  }
  return axis;
}

VentricleAxis axisFromBase(std::span<const Facet> cavity, Vec3d base) {
  const double farthest = farthestFrom(cavity, base);
  const Facets tip = partAbove(
      cavity, [&](Vec3d p) { return length(p - base); }, (1 - kApexShare) * farthest);
  return {base, base + farthest * normalised(middleOf(tip) - base)};
}

VentricleAxis axisOfCavity(std::span<const Facet> cavity, Vec3d towards_base) {
  const Vec3d axis = principalAxis(cavity);
  double low = dot(cavity.front()[0], axis), high = low;
  for (const Facet& f : cavity)
    for (const Vec3d p : f) {
      low = std::min(low, dot(p, axis));
      high = std::max(high, dot(p, axis));
    }
  const double cap = kCapShare * (high - low);
  const Facets first = between(cavity, axis, low, low + cap),
               last = between(cavity, axis, high - cap, high);
  const double side = dot(towards_base, axis);
  const bool base_last = side != 0 ? side > 0 : widthOf(last, axis) > widthOf(first, axis);
  const Vec3d outward = base_last ? axis : -axis;
  return axisFromBase(cavity, middleOf(base_last ? last : first) + 0.25 * cap * outward);
}

}  // namespace echocine
