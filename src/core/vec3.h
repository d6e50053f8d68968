#pragma once
// Three-vectors and rigid frames. Aggregates without constructors: Vec3d{x, y, z}.

#include <cmath>

namespace echocine {

template <typename T>
struct Vec3 {
  T x{}, y{}, z{};

  friend constexpr Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(T s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
  friend constexpr Vec3 operator*(Vec3 a, T s) { return s * a; }
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

template <typename T>
constexpr T dot(Vec3<T> a, Vec3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <typename T>
constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <typename T>
T length(Vec3<T> a) {
  return std::sqrt(dot(a, a));
}

// Precondition: a is not the zero vector.
template <typename T>
Vec3<T> normalised(Vec3<T> a) {
  return (T(1) / length(a)) * a;
}

inline bool isFinite(Vec3d a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

constexpr Vec3d toDouble(Vec3f a) {
  return {a.x, a.y, a.z};
}
constexpr Vec3f toFloat(Vec3d a) {
  return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

// An orthonormal, right- or left-handed frame: its three axes and its origin in world coordinates.
struct Pose {
  Vec3d origin;
  Vec3d x_axis{1, 0, 0}, y_axis{0, 1, 0}, z_axis{0, 0, 1};

  // Coordinates of a world point in this frame.
  Vec3d fromWorld(Vec3d point) const {
    const Vec3d d = point - origin;
    return {dot(d, x_axis), dot(d, y_axis), dot(d, z_axis)};
  }
  // And back.
  Vec3d toWorld(Vec3d p) const { return origin + p.x * x_axis + p.y * y_axis + p.z * z_axis; }
};

}  // namespace echocine
