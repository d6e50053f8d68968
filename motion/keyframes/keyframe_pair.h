#pragma once
// Two successive keyframes, and checks of frames between them.

#include <cstdint>
#include <optional>
#include <vector>

#include "motion/keyframes/motion_check.h"

namespace echocine {

// Two triangles with a common edge.
struct Neighbours {
  std::uint32_t a = 0, b = 0;
};
std::vector<Neighbours> neighboursOf(std::span<const Triangle> triangles);

class KeyframePair {
 public:
  // Keeps the references.
  KeyframePair(const ControlMotion& motion, const std::vector<Neighbours>& neighbours,
               std::size_t left, std::size_t right);

  // Checks a frame between the two and adds its findings; isBroken() has the triangles.
  void look(const FramePhase& at, SurfaceBreaks& breaks);

  const std::vector<bool>& isBroken() const { return is_broken_; }  // triangles, in any frame

 private:
  // Normals of triangles. In a keyframe, zero for triangles too thin to have one.
  struct Sides {
    std::vector<Vec3f> normal;
    std::vector<double> double_area_m2;
    double size = 0;  // volume of a closed surface, m^3, area of a membrane, m^2
  };
  // An edge that is unfolded in both keyframes.
  struct OpenEdge {
    Neighbours triangles;
    bool open_in_left, folded_in_other;
  };
  Sides sidesOf(std::size_t keyframe) const;
  void measure(const std::vector<Vec3f>& positions_m, Sides& sides) const;
  void lookAtTriangles(const FramePhase& at, const Sides& sides, SurfaceBreaks& breaks);
  void lookAtEdges(const FramePhase& at, const Sides& sides, SurfaceBreaks& breaks);
  void lookAtSize(const FramePhase& at, double size, SurfaceBreaks& breaks) const;
  void lookAtRange(const FramePhase& at, double volume_m3, SurfaceBreaks& breaks) const;
  void note(const FramePhase& at, std::uint32_t triangle, TriangleBreak kind,
            SurfaceBreaks& breaks);

  const ControlMotion& motion_;
  std::size_t left_, right_;
  Sides left_sides_, right_sides_;
  std::vector<OpenEdge> open_edges_;
  std::vector<bool> is_broken_;
};

}  // namespace echocine
