#include "motion/interior/border_points.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace echocine {

namespace {

// Large triangles are cut into at most this many parts a side. Our choice: a wall of a metre still
// has a point every two centimetres.
constexpr int kMostParts = 48;

double longestEdge(Vec3f a, Vec3f b, Vec3f c) {
  return static_cast<double>(std::max({length(a - b), length(b - c), length(c - a)}));
}

class Candidates {
 public:
  Candidates(SurfaceId surface, std::span<const Vec3f> positions_m, const Box& region)
      : surface_(surface), positions_m_(positions_m), region_(region) {}

  void add(const Triangle& corners, float s0, float s1, float s2) {
    BorderPoint point{surface_, {corners[0], corners[1], corners[2]}, {s0, s1, s2}, {}, 0};
    point.reference_m = placeOf(point, positions_m_);
    if (region_.contains(toDouble(point.reference_m))) points.push_back(point);
  }

  // The middles of its parts, were it cut evenly so that none is longer than the spacing.
  void addWithin(const Triangle& t, double spacing_m) {
    const double longest = longestEdge(positions_m_[t[0]], positions_m_[t[1]], positions_m_[t[2]]);
    if (longest <= 1.2 * spacing_m) return;
    const int parts = std::min(static_cast<int>(std::ceil(longest / spacing_m)), kMostParts);
    const float part = 1 / static_cast<float>(parts);
    for (int i = 0; i < parts; ++i)
      for (int j = 0; i + j < parts; ++j) {
        const float s1 = (static_cast<float>(i) + 1.0f / 3) * part,
                    s2 = (static_cast<float>(j) + 1.0f / 3) * part;
        add(t, 1 - s1 - s2, s1, s2);
      }
  }

  std::vector<BorderPoint> points;

 private:
  SurfaceId surface_;
  std::span<const Vec3f> positions_m_;
  const Box& region_;
};

}  // namespace

std::vector<BorderPoint> borderPoints(std::span<const InteriorSurface> surfaces,
                                      std::span<const std::vector<Vec3f>> reference_m,
                                      const TopSurfaces& tops, const Box& region,
                                      double spacing_m) {
  std::vector<BorderPoint> points;
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    if (surfaces[s].membrane) continue;
    Candidates candidates(static_cast<SurfaceId>(s), reference_m[s], region);
    for (std::uint32_t v = 0; v < reference_m[s].size(); ++v) candidates.add({v, v, v}, 1, 0, 0);
    for (const Triangle& t : surfaces[s].triangles) candidates.addWithin(t, spacing_m);
    points.insert(points.end(), candidates.points.begin(), candidates.points.end());
  }
  constexpr std::uint32_t kHidden = 0xffffffff;
  parallelBlocks(points.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      BorderPoint& point = points[i];
      const Vec3d p = toDouble(point.reference_m);
      const auto beyond = tops.at(p, point.surface);
      if (beyond && tops.isStronger(*beyond, point.surface))
        point.beyond = kHidden;
      else
        point.beyond = static_cast<std::uint32_t>(beyond ? index(*beyond) : surfaces.size());
    }
  });
  std::erase_if(points, [](const BorderPoint& point) { return point.beyond == kHidden; });
  return points;
}

}  // namespace echocine
