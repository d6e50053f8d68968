#include "echo/sector_edges.h"

#include <cmath>

#include "core/hash_random.h"

namespace echocine::echo {

namespace {

// Fit to the points within the tolerance of an approximate line. The regression is of x on y,
// because edges are steep.
EdgeLine leastSquares(const std::vector<EdgePoint>& points, const EdgeLine& near,
                      double tolerance) {
  double n = 0, sx = 0, sy = 0, syy = 0, sxy = 0;
  for (const EdgePoint p : points) {
    if (std::abs(p.x - near.at_zero - near.slope * p.y) > tolerance) continue;
    ++n, sx += p.x, sy += p.y, syy += p.y * p.y, sxy += p.x * p.y;
  }
  const double d = n * syy - sy * sy;
  if (n < 3 || d <= 0) return near;
  const double slope = (n * sxy - sx * sy) / d;
  return {(sx - slope * sy) / n, slope, static_cast<int>(n)};
}

}  // namespace

std::vector<EdgePoint> outermost(const EchoPixels& area, int sign) {
  std::vector<EdgePoint> points;
  for (int y = 0; y < area.height; ++y) {
    int first = -1, last = -1;
    for (int x = 0; x < area.width; ++x)
      if (area.at(x, y)) {
        if (first < 0) first = x;
        last = x;
      }
    if (first < 0 || (sign < 0 ? first == 0 : last == area.width - 1)) continue;
    points.push_back({sign < 0 ? first : last + 1.0, y + 0.5});
  }
  return points;
}

// Speckle leaves gaps, so points lie inside the true edge more often than outside: a point outside
// counts against the line.
std::optional<EdgeLine> edgeLine(const std::vector<EdgePoint>& points, int sign, double tolerance) {
  if (points.size() < 8) return std::nullopt;
  // Pairs of points. With half of them on the edge every fourth pair hits it, so 1500 find it for
  // certain; hashed, so the same loop always gives the same sector.
  constexpr std::uint64_t kTries = 1500;
  EdgeLine best;
  double best_score = 0;
  for (std::uint64_t t = 0; t < kTries; ++t) {
    const auto pick = [&](std::uint64_t k) {
      return points[static_cast<std::size_t>(
          uniformFromHash(hashOf(t, k, std::uint64_t(sign + 2))) *
          static_cast<double>(points.size()))];
    };
    const EdgePoint a = pick(0), b = pick(1);
    // Points close together say little of the slope.
    if (std::abs(a.y - b.y) < 0.05 * static_cast<double>(points.size())) continue;
    EdgeLine line;
    line.slope = (b.x - a.x) / (b.y - a.y);
    line.at_zero = a.x - line.slope * a.y;
    if (sign * line.slope < 0.08 || sign * line.slope > 4) continue;  // 5 to 76 degrees
    double score = 0;
    for (const EdgePoint p : points) {
      const double outside = sign * (p.x - line.at_zero - line.slope * p.y);
      if (std::abs(outside) <= tolerance)
        score += 1, ++line.inliers;
      else if (outside > 0)
        score -= 1;
    }
    if (score > best_score) {
      best_score = score;
      best = line;
    }
  }
  if (best.inliers < 8) return std::nullopt;
  for (int i = 0; i < 4; ++i) best = leastSquares(points, best, tolerance);
  return best;
}

}  // namespace echocine::echo
