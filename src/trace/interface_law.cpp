#include "trace/interface_law.h"

#include <algorithm>
#include <cmath>

namespace echocine {

std::optional<double> transmissionCosine(double cos_i, double c_1, double c_2) {
  const double r = c_2 / c_1;
  // 1 - r^2 sin^2 as (1 - r)(1 + r) + r^2 cos^2: no cancellation when r is near 1.
  const double cos_t_squared = (1 - r) * (1 + r) + r * r * cos_i * cos_i;
  if (cos_t_squared <= 0 && r > 1) return std::nullopt;
  return std::min(std::sqrt(std::max(cos_t_squared, 0.0)), 1.0);
}

double reflectance(double Z_1, double Z_2, double cos_i, double cos_t) {
  const double sum = Z_2 * cos_i + Z_1 * cos_t;
  // Both cosines 0: a tangent ray between equal speeds, where the ratio is that of normal
  // incidence.
  const double ratio = sum > 0 ? (Z_2 * cos_i - Z_1 * cos_t) / sum : (Z_2 - Z_1) / (Z_2 + Z_1);
  return ratio * ratio;
}

double transmittance(double Z_1, double Z_2, double cos_i, double cos_t) {
  const double sum = Z_2 * cos_i + Z_1 * cos_t;
  if (!(sum > 0)) return 4 * Z_2 * Z_1 / ((Z_2 + Z_1) * (Z_2 + Z_1));
  return 4 * Z_2 * Z_1 * cos_i * cos_i / (sum * sum);
}

double nonSpecularReturn(double W, double cos_i, double n) {
  if (n == 0) return W;
  if (n == 1) return W * cos_i;
  if (n == 2) return W * cos_i * cos_i;
  return W * std::pow(cos_i, n);
}

InterfaceLaw interfaceLaw(double Z_1, double c_1, double Z_2, double c_2, double cos_i) {
  const std::optional<double> cos_t = transmissionCosine(cos_i, c_1, c_2);
  if (!cos_t) return {1, true};
  return {reflectance(Z_1, Z_2, cos_i, *cos_t), false};
}

std::optional<Vec3d> refracted(Vec3d direction, Vec3d normal, double c_1, double c_2) {
  if (c_1 == c_2) return direction;
  const double along = dot(direction, normal);
  const Vec3d forward = along < 0 ? -normal : normal;
  const double cos_i = std::min(std::abs(along), 1.0);
  const std::optional<double> cos_t = transmissionCosine(cos_i, c_1, c_2);
  if (!cos_t) return std::nullopt;
  const double r = c_2 / c_1;
  return normalised(r * direction + (*cos_t - r * cos_i) * forward);
}

}  // namespace echocine
