#include "truth/sector_clip.h"

#include <cmath>

namespace echocine {

std::vector<Vec3d> sectorOutline(const Probe& probe) {
  if (probe.kind == ProbeKind::linear)
    return {{probe.first_offset_m, 0, probe.min_depth_m},
            {probe.last_offset_m, 0, probe.min_depth_m},
            {probe.last_offset_m, 0, probe.max_depth_m},
            {probe.first_offset_m, 0, probe.max_depth_m}};
  constexpr int kArcPoints = 257;
  std::vector<Vec3d> outline{{0, 0, 0}};
  const double radius_m = probe.face_radius_m + probe.max_depth_m;
  for (int i = 0; i < kArcPoints; ++i) {
    const double angle = probe.last_angle_rad +
                         (probe.first_angle_rad - probe.last_angle_rad) * i / (kArcPoints - 1);
    outline.push_back({radius_m * std::sin(angle), 0, radius_m * std::cos(angle)});
  }
  return outline;
}

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
