#pragma once
// One number for each sample of a frame in beam space, line-major: the samples of line 0 from
// shallow to deep, then those of line 1, and so on. The quantity is part of the type, so
// intensities cannot be used as grey levels. release() passes the memory from one plane to another.

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace echocine {

template <typename Quantity>
class BeamPlane {
 public:
  BeamPlane() = default;
  explicit BeamPlane(std::vector<float> line_major) : values(std::move(line_major)) {}

  std::vector<float> values;

  std::size_t size() const { return values.size(); }
  bool empty() const { return values.empty(); }
  void resize(std::size_t count) { values.resize(count); }
  float& operator[](std::size_t i) { return values[i]; }
  float operator[](std::size_t i) const { return values[i]; }
  auto begin() const { return values.begin(); }
  auto end() const { return values.end(); }
  operator std::span<const float>() const { return values; }
  operator std::span<float>() { return values; }

  // Releases the memory; the plane is then empty.
  std::vector<float> release() { return std::exchange(values, {}); }

  friend bool operator==(const BeamPlane&, const BeamPlane&) = default;
};

// Scan lines first <= line < end.
struct LineRange {
  int first = 0, end = 0;
  int count() const { return end - first; }
};

// Received intensities relative to the transmitted I_S, from the trace stage or from the signal
// chain up to the beam average.
using Intensities = BeamPlane<struct IntensityQuantity>;
// After log compression: 0 black, 1 white.
using Greys = BeamPlane<struct GreyQuantity>;

}  // namespace echocine
