#pragma once
// Creases and corners of a control mesh: edges and points that Loop subdivision keeps sharp.

#include <cstdint>
#include <vector>

namespace echocine {

// Sharp at every level from this value on: OpenSubdiv's Sdc::Crease::SHARPNESS_INFINITE.
inline constexpr float kInfiniteSharpness = 10;

// Sharpness in (0, 10]: the number of levels, possibly fractional, that keep the edge or point
// before the smooth rules apply (DeRose, Kass and Truong, "Subdivision surfaces in character
// animation", SIGGRAPH 1998).
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

// Ascending by vertices, each named once, so equal tags compare equal for any order in the file.
struct MeshTags {
  std::vector<SharpEdge> edges;
  std::vector<SharpVertex> vertices;

  bool empty() const { return edges.empty() && vertices.empty(); }
  friend bool operator==(const MeshTags&, const MeshTags&) = default;
};

// Both ends of an edge in one number, for either direction.
inline std::uint64_t edgeKey(std::uint32_t a, std::uint32_t b) {
  return a < b ? std::uint64_t{a} << 32 | b : std::uint64_t{b} << 32 | a;
}

}  // namespace echocine
