#pragma once
// Creases and corners of a control mesh: where Loop subdivision is to keep an edge or a point.

#include <cstdint>
#include <vector>

namespace echocine {

// From here on sharp at every level: OpenSubdiv's Sdc::Crease::SHARPNESS_INFINITE.
inline constexpr float kInfiniteSharpness = 10;

// Sharpness in (0, 10]: as many levels, counted in fractions, keep the edge or point before the
// smooth rules take over (DeRose, Kass and Truong, "Subdivision surfaces in character animation",
// SIGGRAPH 1998).
struct SharpEdge {
  std::uint32_t v0 = 0, v1 = 0;  // v0 < v1
  float sharpness = 0;
  friend bool operator==(const SharpEdge&, const SharpEdge&) = default;
};
struct SharpVertex {
  std::uint32_t v = 0;
  float sharpness = 0;
  friend bool operator==(const SharpVertex&, const SharpVertex&) = default;
};

// Ascending by vertices and each named once, so equal tags compare equal in whatever order a file
// has them.
struct MeshTags {
  std::vector<SharpEdge> edges;
  std::vector<SharpVertex> vertices;

  bool empty() const { return edges.empty() && vertices.empty(); }
  friend bool operator==(const MeshTags&, const MeshTags&) = default;
};

// Both ends of an edge in one number, whichever way it runs.
inline std::uint64_t edgeKey(std::uint32_t a, std::uint32_t b) {
  return a < b ? std::uint64_t{a} << 32 | b : std::uint64_t{b} << 32 | a;
}

}  // namespace echocine
