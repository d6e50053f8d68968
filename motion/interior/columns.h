#pragma once
// Intersections of lines along x with a closed surface: an inside test for places and for whole
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
    int change;  // of the winding number towards greater x
  };

  // Copies what it needs. Faces look outward.
  Columns(std::span<const Triangle> triangles, std::span<const Vec3f> positions_m);

  const Box& box() const { return box_m_; }

  // In ascending order. By half-open comparisons of doubles, so shared edges and vertices count
  // once.
  void crossings(double y, double z, std::vector<Crossing>& out) const;

  // Is the place inside, with a winding number above 0? Overlaps count as inside.
  bool contains(Vec3d place_m) const;

  // False: no triangle passes through the box, so all its places are inside or all are outside.
  bool mayPass(const Box& box_m) const;

 private:
  // A triangle of a bin, with bounds of its possible crossings.
  struct Member {
    float lo_x, hi_x, lo_y, hi_y, lo_z, hi_z;  // m, a little wider than the triangle
    std::uint32_t triangle;
    // Can the line at (y, z) cross it, at no greater x?
    bool mayCross(float x, float y, float z) const {
      return (lo_y <= y) & (y <= hi_y) & (lo_z <= z) & (z <= hi_z) & (lo_x <= x);
    }
  };
  // (x, z) at which a triangle's edge passes the height y; the same for both its faces.
  struct Cut {
    double x, z;
  };
  Cut cutEdge(std::uint32_t a, std::uint32_t b, double y) const;
  bool cross(const Triangle& triangle, double y, double z, Crossing& out) const;
  int binAlongY(double y) const;
  int binAlongZ(double z) const;
  std::span<const Member> bin(int y, int z) const;
  std::span<const Member> bin(double y, double z) const;
  Member memberOf(std::uint32_t triangle) const;
  void fillBins();

  std::vector<Triangle> triangles_;
  std::vector<Vec3d> positions_m_;
  Box box_m_;
  int bins_ = 1;                       // along each axis
  std::vector<std::uint32_t> starts_;  // of each bin in members_
  std::vector<Member> members_;
};

}  // namespace echocine
