#pragma once
// Where lines along x cross a closed surface: tells inside from outside, for places and for whole
// rows of a lattice.

#include <cstdint>
#include <span>
#include <vector>

#include "core/box.h"
#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine {

class Columns {
 public:
  struct Crossing {
    double x;
    int change;  // of the winding number on the way to greater x
  };

  // Copies what it needs. Faces look outward.
  Columns(std::span<const Triangle> triangles, std::span<const Vec3f> positions_m);

  const Box& box() const { return box_m_; }

  // In ascending order. By half-open comparisons of doubles, so shared edges and vertices count
  // once.
  void crossings(double y, double z, std::vector<Crossing>& out) const;

  // Is the place inside, with a winding number above 0? What overlaps itself is inside.
  bool contains(Vec3d place_m) const;

 private:
  // (x, z) where a triangle's edge passes the height y; the same for both its faces.
  struct Cut {
    double x, z;
  };
  Cut cutEdge(std::uint32_t a, std::uint32_t b, double y) const;
  bool cross(const Triangle& triangle, double y, double z, Crossing& out) const;
  std::span<const std::uint32_t> bin(double y, double z) const;
  void fillBins();

  std::vector<Triangle> triangles_;
  std::vector<Vec3d> positions_m_;
  Box box_m_;
  int bins_ = 1;                        // a side
  std::vector<std::uint32_t> starts_;   // of each bin in members_
  std::vector<std::uint32_t> members_;  // triangles
};

}  // namespace echocine
