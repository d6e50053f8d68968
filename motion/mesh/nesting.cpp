#include "motion/mesh/nesting.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "motion/mesh/surface_measure.h"

namespace echocine {

namespace {

// Solid angle that a triangle shows to the origin, over 4 pi. Van Oosterom and Strackee, IEEE
// Trans. Biomed. Eng. 30 (1983).
double turns(Vec3d a, Vec3d b, Vec3d c) {
  const double la = length(a), lb = length(b), lc = length(c);
  const double above = dot(a, cross(b, c));
  const double below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return std::atan2(above, below) / (2 * std::numbers::pi);
}

bool holds(const Box& outer, const Box& inner) {
  return outer.lo.x <= inner.lo.x && outer.lo.y <= inner.lo.y && outer.lo.z <= inner.lo.z &&
         outer.hi.x >= inner.hi.x && outer.hi.y >= inner.hi.y && outer.hi.z >= inner.hi.z;
}

}  // namespace

Nesting::Nesting(std::span<const Triangle> triangles, std::span<const Vec3d> positions,
                 const Pieces& pieces)
    : triangles_(triangles), positions_(positions), pieces_(pieces.count) {
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    Piece& piece = pieces_[pieces.of_triangle[t]];
    piece.triangles.push_back(t);
    for (const std::uint32_t v : triangles[t]) piece.box.add(positions[v]);
  }
}

// Tested from three of its corners, because one may lie on the other's surface.
bool Nesting::isInside(const Piece& inner, const Piece& outer) const {
  double sum = 0;
  const std::size_t count = inner.triangles.size();
  for (const std::size_t i : {std::size_t{0}, count / 3, 2 * count / 3}) {
    const Vec3d eye = positions_[triangles_[inner.triangles[i]][0]];
    for (const std::uint32_t t : outer.triangles)
      sum += turns(positions_[triangles_[t][0]] - eye, positions_[triangles_[t][1]] - eye,
                   positions_[triangles_[t][2]] - eye);
  }
  return std::abs(sum) / 3 > 0.5;
}

std::vector<std::uint32_t> Nesting::around(std::uint32_t piece) const {
  std::vector<std::uint32_t> found;
  for (std::uint32_t other = 0; other < pieces_.size(); ++other)
    if (other != piece && holds(pieces_[other].box, pieces_[piece].box) &&
        isInside(pieces_[piece], pieces_[other]))
      found.push_back(other);
  return found;
}

double Nesting::volume(std::uint32_t piece) const {
  std::vector<Triangle> faces;
  for (const std::uint32_t t : pieces_[piece].triangles) faces.push_back(triangles_[t]);
  const double volume = enclosedVolume(faces, [&](std::uint32_t v) { return positions_[v]; });
  const double size = length(pieces_[piece].box.hi - pieces_[piece].box.lo);
  return 6 * std::abs(volume) > 1e-12 * size * size * size ? volume : 0;
}

}  // namespace echocine
