#include "motion/mesh/surface_measure.h"

#include <algorithm>
#include <cstring>
#include <optional>

#include "core/lanes.h"

namespace echocine {

double enclosedVolume(std::span<const Triangle> triangles, std::span<const Vec3f> positions_m) {
  return enclosedVolume(triangles, [&](std::uint32_t v) { return toDouble(positions_m[v]); });
}

namespace {

// A point in one vector. The fourth lane is unused.
using WidePoint = Doubles4;

// Relative to the point with the number `first`.
void widen(std::span<const Vec3f> positions, std::uint32_t first, std::vector<WidePoint>& points) {
  points.resize(positions.size());
  const auto wide = [](Vec3f p) { return WidePoint{p.x, p.y, p.z, 0}; };
  const WidePoint reference = wide(positions[first]);
  const std::size_t last = positions.size() - 1;
  for (std::size_t v = 0; v < last; ++v) {
    Floats4 point;
    std::memcpy(&point, &positions[v], sizeof point);  // and the next one's x
    points[v] = __builtin_convertvector(point, WidePoint) - reference;
  }
  points[last] = wide(positions[last]) - reference;
}

// p x q with its coordinates in the order z, x, y.
WidePoint turnedCross(WidePoint p, WidePoint q) {
  const auto turned = [](WidePoint r) { return __builtin_shufflevector(r, r, 1, 2, 0, 3); };
  return p * turned(q) - turned(p) * q;
}

// The same triangle, starting at another corner.
Triangle from(const Triangle& t, std::size_t corner) {
  return {t[corner], t[(corner + 1) % 3], t[(corner + 2) % 3]};
}

// The corners a, b, c, d of two triangles of the form (a, b, c) and (a, c, d).
std::optional<std::array<std::uint32_t, 4>> joined(const Triangle& t, const Triangle& u) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const Triangle first = from(t, i), second = from(u, j);
      if (first[0] == second[0] && first[2] == second[1])
        return std::array{first[0], first[1], first[2], second[2]};
    }
  return std::nullopt;
}

}  // namespace

// Meshes mostly list triangles next to their neighbours: two of a quadrilateral, those of a strip,
// the parts of a divided one.
VolumeSum::VolumeSum(std::span<const Triangle> triangles) {
  constexpr std::size_t kAhead = 3;  // a divided triangle's parts are four
  if (triangles.empty()) return;
  std::vector<bool> taken(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (taken[i]) continue;
    const Triangle& t = triangles[i];
    pairs_.push_back({t[0], t[1], t[2], pairs_.empty() ? t[0] : pairs_.front()[0]});
    const std::size_t end = std::min(i + 1 + kAhead, triangles.size());
    for (std::size_t next = i + 1; next < end; ++next) {
      if (taken[next]) continue;
      const auto pair = joined(t, triangles[next]);
      if (!pair) continue;
      pairs_.back() = *pair;
      taken[next] = true;
      break;
    }
  }
}

double VolumeSum::of(std::span<const Vec3f> positions_m) const {
  if (pairs_.empty()) return 0;
  thread_local std::vector<WidePoint> points;  // each belongs to three pairs or so
  widen(positions_m, pairs_.front()[0], points);
  const WidePoint* point = points.data();
  WidePoint sum{};
  for (const auto& [a, b, c, d] : pairs_)
    sum += __builtin_shufflevector(point[a], point[a], 2, 0, 1, 3) *
           turnedCross(point[c], point[d] - point[b]);
  return (sum[0] + sum[1] + sum[2]) / 6.0;
}

}  // namespace echocine
