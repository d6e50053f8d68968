#include "trace/interface_law.h"

#include <algorithm>
#include <cmath>

namespace echocine {

std::optional<double> transmissionCosine(double cos_i, double c_1, double c_2) {
  if (c_1 == c_2) return cos_i;
  const double r = c_2 / c_1;
  // 1 - r^2 sin^2 as (c_1 - c_2)(c_1 + c_2) / c_1^2 + r^2 cos^2: the difference of like speeds is
  // exact, that of 1 and their rounded ratio would move the critical angle by many ulps.
  const double cos_t_squared = (c_1 - c_2) / c_1 * (1 + r) + r * r * cos_i * cos_i;
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

namespace {

// Z_2 cos_i - Z_1 cos_t. For nearly equal media it is the sum of a part from the impedances and one
// from the speeds: (Z_2 - Z_1) cos_i + Z_1 (cos_i - cos_t), where cos_i^2 - cos_t^2 is
// (r^2 - 1) sin^2. The form with the smaller terms, and so the smaller rounding error, is used.
double amplitudeDifference(double Z_1, double c_1, double Z_2, double c_2, double cos_i,
                           double cos_t) {
  const double plain = Z_2 * cos_i - Z_1 * cos_t;
  const double cosines = cos_i + cos_t;
  if (!(cosines > 0)) return plain;
  const double bending = (c_2 - c_1) / c_1 * (1 + c_2 / c_1) * (1 - cos_i) * (1 + cos_i) / cosines;
  const double by_Z = (Z_2 - Z_1) * cos_i, by_c = Z_1 * bending;
  const bool alike = std::abs(by_Z) + std::abs(by_c) < Z_2 * cos_i + Z_1 * cos_t;
  return alike ? by_Z + by_c : plain;
}

}  // namespace

InterfaceLaw interfaceLaw(double Z_1, double c_1, double Z_2, double c_2, double cos_i) {
  if (c_1 == c_2) {  // the same at every angle
    const double per_sum = 1 / (Z_2 + Z_1), ratio = (Z_2 - Z_1) * per_sum;
    return {ratio * ratio, 4 * (Z_2 * per_sum) * (Z_1 * per_sum), false, ratio};
  }
  const std::optional<double> cos_t = transmissionCosine(cos_i, c_1, c_2);
  if (!cos_t) return {1, 0, true, 1};
  const double a = Z_2 * cos_i, b = Z_1 * *cos_t, sum = a + b;
  if (!(sum > 0)) {
    const double R = reflectance(Z_1, Z_2, cos_i, *cos_t);
    return {R, 1 - R, false, (Z_2 - Z_1) / (Z_2 + Z_1)};
  }
  const double ratio = amplitudeDifference(Z_1, c_1, Z_2, c_2, cos_i, *cos_t) / sum;
  // 1 - ((a - b) / (a + b))^2 = 4 a b / (a + b)^2
  return {ratio * ratio, 4 * (a / sum) * (b / sum), false, ratio};
}

double cappedReflectance(double R, double Z_1, double Z_2) {
  const double per_sum = 1 / (Z_2 + Z_1), ratio = (Z_2 - Z_1) * per_sum;
  return std::min(R, ratio * ratio);
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
