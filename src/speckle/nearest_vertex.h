#pragma once
// The nearest of many points, by bins.

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.h"

namespace echocine {

class NearestVertex {
 public:
  // Precondition: at least one point.
  explicit NearestVertex(std::span<const Vec3f> points_m);
  Vec3f to(Vec3f place_m) const;  // among equals the first

 private:
  std::size_t bin(int x, int y, int z) const;
  int binOf(float at, float low, int count) const;

  std::vector<Vec3f> points_m_;  // bin by bin
  std::vector<std::uint32_t> starts_;
  Vec3f low_m_;
  float edge_m_ = 1;
  int nx_ = 1, ny_ = 1, nz_ = 1;
};

}  // namespace echocine
