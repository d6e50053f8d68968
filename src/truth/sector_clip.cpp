#include "truth/sector_clip.h"

namespace echocine {

std::vector<Vec3d> clipped(std::vector<Vec3d> polygon, const std::vector<Vec3d>& outline) {
  for (std::size_t e = 0; e < outline.size() && !polygon.empty(); ++e) {
    const Vec3d a = outline[e], b = outline[(e + 1) % outline.size()];
    // Over 0 on the inner side, for an outline that turns from x towards z.
    const auto side = [&](Vec3d p) {
      return (b.x - a.x) * (p.z - a.z) - (b.z - a.z) * (p.x - a.x);
    };
    std::vector<Vec3d> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3d p = polygon[i], q = polygon[(i + 1) % polygon.size()];
      const double sp = side(p), sq = side(q);
      if (sp >= 0) kept.push_back(p);
      if ((sp >= 0) != (sq >= 0)) kept.push_back(p + (sp / (sp - sq)) * (q - p));
    }
    polygon = std::move(kept);
  }
  return polygon;
}

}  // namespace echocine
