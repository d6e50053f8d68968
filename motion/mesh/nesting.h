#pragma once
// Containment of the pieces of a mesh.

#include <span>
#include <vector>

#include "core/box.h"
#include "core/vec3.h"
#include "motion/mesh/edge_sides.h"

namespace echocine {

// Largest number of pieces that are compared pairwise. Our choice.
inline constexpr std::uint32_t kMaxNestedPieces = 256;

class Nesting {
 public:
  // Keeps both spans. Precondition: faces of a piece are consistently oriented.
  Nesting(std::span<const Triangle> triangles, std::span<const Vec3d> positions,
          const Pieces& pieces);

  // The closed pieces that contain a piece, by winding number and for either orientation. Pieces
  // that only overlap do not count.
  std::vector<std::uint32_t> around(std::uint32_t piece) const;

  // Signed, by the divergence theorem; 0 if it is within rounding.
  double volume(std::uint32_t piece) const;
  const std::vector<std::uint32_t>& trianglesOf(std::uint32_t piece) const {
    return pieces_[piece].triangles;
  }

 private:
  struct Piece {
    std::vector<std::uint32_t> triangles;
    Box box;
  };
  bool isInside(const Piece& inner, const Piece& outer) const;

  std::span<const Triangle> triangles_;
  std::span<const Vec3d> positions_;
  std::vector<Piece> pieces_;
};

}  // namespace echocine
