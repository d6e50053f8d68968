#include "motion/surface_measure.h"

#include <vector>

namespace echocine {

namespace {

// A point in one vector register, the fourth lane 0: an extension that GCC and Clang share.
using WidePoint [[gnu::vector_size(32)]] = double;

// b x c with its coordinates in the order z, x, y.
WidePoint turnedCross(WidePoint b, WidePoint c) {
  const auto turned = [](WidePoint p) { return __builtin_shufflevector(p, p, 1, 2, 0, 3); };
  return b * turned(c) - turned(b) * c;
}

}  // namespace

double enclosedVolume(std::span<const Triangle> triangles, std::span<const Vec3f> positions_m) {
  // Each vertex is widened once: it belongs to six triangles or so.
  thread_local std::vector<WidePoint> points;
  points.resize(positions_m.size());
  const Vec3d reference = toDouble(positions_m[triangles.front()[0]]);
  WidePoint* point = points.data();
  for (const Vec3f& p : positions_m) {
    const Vec3d q = toDouble(p) - reference;
    *point++ = WidePoint{q.x, q.y, q.z, 0};
  }
  point = points.data();
  WidePoint sum{};
  for (const Triangle& t : triangles) {
    const WidePoint a = point[t[0]];
    sum += __builtin_shufflevector(a, a, 2, 0, 1, 3) * turnedCross(point[t[1]], point[t[2]]);
  }
  return (sum[0] + sum[1] + sum[2]) / 6.0;
}

}  // namespace echocine
