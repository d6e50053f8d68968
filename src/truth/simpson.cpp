#include "truth/simpson.h"

#include <algorithm>
#include <numbers>

namespace echocine {

namespace {

// The plane's cut of one triangle, relative to the base; false where it misses.
bool cutTriangle(const Triangle& t, std::span<const Vec3f> p, Vec3d base_m, Vec3d normal,
                 Vec3d (&cut)[2]) {
  int count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t lower = std::min(t[i], t[(i + 1) % 3]),
                        upper = std::max(t[i], t[(i + 1) % 3]);
    const Vec3d a = toDouble(p[lower]) - base_m, b = toDouble(p[upper]) - base_m;
    const double ha = dot(a, normal), hb = dot(b, normal);
    if ((ha >= 0) != (hb >= 0) && count < 2) cut[count++] = a + (ha / (ha - hb)) * (b - a);
  }
  return count == 2;
}

// Inside is between the first and the second crossing, the third and the fourth, and so on.
double widthOf(std::vector<double>& crossings) {
  std::sort(crossings.begin(), crossings.end());
  double width = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2)
    width += crossings[i + 1] - crossings[i];
  return width;
}

}  // namespace

std::vector<double> discWidths(std::span<const Triangle> triangles,
                               std::span<const Vec3f> positions_m, const LongAxis& long_axis,
                               Vec3d across) {
  const Vec3d span = long_axis.apex_m - long_axis.base_m, axis = normalised(span),
              wide = normalised(across - dot(across, axis) * axis), normal = cross(axis, wide);
  const double length_m = length(span);
  std::vector<std::vector<double>> crossings(kDiscs);
  Vec3d cut[2];
  for (const Triangle& t : triangles) {
    if (!cutTriangle(t, positions_m, long_axis.base_m, normal, cut)) continue;
    const double z0 = dot(cut[0], axis), z1 = dot(cut[1], axis);
    for (int i = 0; i < kDiscs; ++i) {
      const double z = (i + 0.5) * length_m / kDiscs;
      if ((z0 >= z) == (z1 >= z)) continue;
      const Vec3d at = cut[0] + ((z - z0) / (z1 - z0)) * (cut[1] - cut[0]);
      crossings[static_cast<std::size_t>(i)].push_back(dot(at, wide));
    }
  }
  std::vector<double> widths;
  for (std::vector<double>& list : crossings) widths.push_back(widthOf(list));
  return widths;
}

double discVolume(double length_m, std::span<const double> a_m, std::span<const double> b_m) {
  double sum_m2 = 0;
  for (std::size_t i = 0; i < a_m.size(); ++i) sum_m2 += a_m[i] * b_m[i];
  return std::numbers::pi / 4 * length_m / kDiscs * sum_m2;
}

}  // namespace echocine
