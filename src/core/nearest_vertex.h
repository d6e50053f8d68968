#pragma once
// The nearest of many points, by spatial bins.

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/vec3.h"

namespace echocine {

class NearestVertex {
 public:
  // Precondition: at least one point.
  explicit NearestVertex(std::span<const Vec3f> points_m);
  Vec3f to(Vec3f place_m) const { return points_m_[*placeOf(place_m, kAnywhere)]; }
  // Index in the given order; none without a point within reach.
  std::optional<std::uint32_t> numberOf(Vec3f place_m, float reach_m = kAnywhere) const {
    const std::optional<std::uint32_t> place = placeOf(place_m, reach_m);
    return place ? std::optional(numbers_[*place]) : std::nullopt;
  }

 private:
  static constexpr float kAnywhere = std::numeric_limits<float>::infinity();
  std::optional<std::uint32_t> placeOf(Vec3f place_m, float reach_m) const;
  std::size_t bin(int x, int y, int z) const;
  int binOf(float at, float low, int count) const;

  std::vector<Vec3f> points_m_;         // ordered by bin
  std::vector<std::uint32_t> numbers_;  // original indices, in the same order
  std::vector<std::uint32_t> starts_;
  Vec3f low_m_;
  float edge_m_ = 1;
  int nx_ = 1, ny_ = 1, nz_ = 1;
};

}  // namespace echocine
