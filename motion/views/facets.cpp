#include "motion/views/facets.h"

#include <algorithm>
#include <cmath>

namespace echocine {

namespace {

// Sides that are equal within rounding count as equal, so that a turned surface is split equally.
constexpr double kEqual = 1e-6;

void addHalves(const Facet& facet, double edge, Facets& to) {
  std::size_t longest = 0;
  double most = 0;
  for (std::size_t k = 0; k < 3; ++k)
    if (const double side = length(facet[(k + 1) % 3] - facet[k]); side > (1 + kEqual) * most) {
      most = side;
      longest = k;
    }
  if (!(most > edge)) {
    to.push_back(facet);
    return;
  }
  const Vec3d a = facet[longest], b = facet[(longest + 1) % 3], c = facet[(longest + 2) % 3];
  const Vec3d half = 0.5 * (a + b);
  addHalves({a, half, c}, edge, to);
  addHalves({half, b, c}, edge, to);
}

}  // namespace

double areaOf(const Facet& f) {
  return 0.5 * length(cross(f[1] - f[0], f[2] - f[0]));
}

Vec3d middleOf(std::span<const Facet> facets) {
  Vec3d sum{}, corners{};
  double area = 0;
  for (const Facet& f : facets) {
    const double of_this = areaOf(f);
    const Vec3d middle = (1.0 / 3) * (f[0] + f[1] + f[2]);
    sum = sum + of_this * middle;
    corners = corners + middle;
    area += of_this;
  }
  return area > 0 ? (1 / area) * sum : (1 / static_cast<double>(facets.size())) * corners;
}

Facets refined(std::span<const Facet> facets, double edge) {
  Facets fine;
  for (const Facet& f : facets) addHalves(f, edge, fine);
  return fine;
}

void addPartAbove(const Facet& f, const std::array<double, 3>& height, Facets& to) {
  std::array<Vec3d, 4> kept{};
  std::size_t n = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (height[i] >= 0) kept[n++] = f[i];
    if ((height[i] >= 0) != (height[j] >= 0))
      kept[n++] = f[i] + (height[i] / (height[i] - height[j])) * (f[j] - f[i]);
  }
  for (std::size_t i = 1; i + 1 < n; ++i) to.push_back({kept[0], kept[i], kept[i + 1]});
}

Facets partAbove(std::span<const Facet> facets, const std::function<double(Vec3d)>& height,
                 double least) {
  Facets part;
  for (const Facet& f : facets)
    addPartAbove(f, {height(f[0]) - least, height(f[1]) - least, height(f[2]) - least}, part);
  return part;
}

// Over a triangle of area A with corners v and their sum s, the integral of x x^T is
// A / 12 (sum of v v^T + s s^T).
std::array<Vec3d, 3> momentsAbout(std::span<const Facet> facets, Vec3d middle) {
  std::array<Vec3d, 3> rows{};
  for (const Facet& f : facets) {
    const double weight = areaOf(f) / 12;
    const std::array<Vec3d, 4> places{f[0] - middle, f[1] - middle, f[2] - middle,
                                      f[0] + f[1] + f[2] - 3.0 * middle};
    for (const Vec3d v : places) {
      rows[0] = rows[0] + weight * v.x * v;
      rows[1] = rows[1] + weight * v.y * v;
      rows[2] = rows[2] + weight * v.z * v;
    }
  }
  return rows;
}

double farthestFrom(std::span<const Facet> facets, Vec3d place) {
  double most = 0;
  for (const Facet& f : facets)
    for (const Vec3d p : f) most = std::max(most, length(p - place));
  return most;
}

}  // namespace echocine
