#pragma once
// Smooth random fields.

#include <array>
#include <cstdint>
#include <vector>

#include "core/vec3.h"

namespace echocine {

// A standard normal field, smooth over `scale_m`: normals hashed on a lattice of that spacing,
// blended with smooth weights and normalised to variance 1 at every place. Fast for nearby places,
// because it keeps cells and nodes. Not thread-safe.
class NormalField {
 public:
  NormalField(double scale_m, std::uint64_t seed);
  double at(Vec3f place_m);

 private:
  // A node's number along each axis, in one word; kNone of nodes too far out to be kept.
  using Key = std::uint64_t;
  static constexpr Key kNone = ~Key{0};
  struct Cell {
    Key key = kNone;
    std::array<double, 8> normals;
  };
  struct Node {
    Key key = kNone;
    double normal;
  };
  static Key keyOf(const std::array<std::int64_t, 3>& node);
  const Cell& cellOf(const std::array<std::int64_t, 3>& node);
  double normalOf(const std::array<std::int64_t, 3>& node);
  double drawn(const std::array<std::int64_t, 3>& node) const;

  double scale_m_;
  std::uint64_t seed_;
  std::array<Cell, 64> cells_{};  // by the last two bits of their nodes. Our choice
  std::vector<Node> nodes_;       // by their last four bits: neighbouring cells share them
};

}  // namespace echocine
