// Hearts of a quarter of the triangles against the refined ones: volumes and places of surfaces.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/vec3.h"
#include "motion/heart/coarse_surfaces.h"
#include "motion/heart/control_mesh.h"
#include "motion/heart/recording.h"
#include "motion/subdivision/shared_subdivision.h"

namespace echocine::coarse_surfaces_law {
namespace {

using heart::RecordedPart;
using heart::Recording;

// Of a part's surface as it is rendered, in the first keyframe.
std::vector<Vec3d> refinedPoints(const RecordedPart& part) {
  const std::vector<Vec3d>& control = part.control_m.front();
  const auto subdivision =
      sharedSubdivision(part.faces, static_cast<std::uint32_t>(control.size()), part.tags, 1, {});
  std::vector<Vec3f> from, to(subdivision->vertexCount());
  for (const Vec3d& p : control) from.push_back(toFloat(p));
  subdivision->apply(from, to);
  std::vector<Vec3d> out;
  for (const Vec3f& p : to) out.push_back(toDouble(p));
  return out;
}

// Distance from a triangle.
double distanceFrom(Vec3d a, Vec3d b, Vec3d c, Vec3d p) {
  const Vec3d ab = b - a, ac = c - a, n = cross(ab, ac), ap = p - a;
  const double square = dot(n, n), u = dot(cross(ap, ac), n) / square,
               v = dot(cross(ab, ap), n) / square;
  if (u >= 0 && v >= 0 && u + v <= 1) return std::abs(dot(ap, n)) / std::sqrt(square);
  const auto fromEdge = [&](Vec3d s, Vec3d e) {
    const double t = std::clamp(dot(p - s, e - s) / dot(e - s, e - s), 0.0, 1.0);
    return length(p - (s + t * (e - s)));
  };
  return std::min({fromEdge(a, b), fromEdge(b, c), fromEdge(c, a)});
}

// By how many metres every 32nd refined point lies off the coarse surface, ascending.
std::vector<double> distances(const RecordedPart& coarse, const RecordedPart& fine) {
  const std::vector<Vec3d>&points = coarse.control_m.front(), refined = refinedPoints(fine);
  std::vector<double> out;
  for (std::size_t i = 0; i < refined.size(); i += 32) {
    out.push_back(1);
    for (const Triangle& t : coarse.faces)
      out.back() =
          std::min(out.back(), distanceFrom(points[t[0]], points[t[1]], points[t[2]], refined[i]));
  }
  std::sort(out.begin(), out.end());
  return out;
}

// A vertex at the control point or at its refined place changes volumes by 1 to 3 %.
TEST(CoarseSurfacesLaw, VolumesAndPlacesAreThoseOfTheRefinedHeart) {
  for (const std::map<std::string, double>& dials :
       {std::map<std::string, double>{},
        {{"ef", 0.25}, {"edv", 230}, {"ellipticity", 0.2}},
        {{"ef", 0.72}, {"edv", 75}, {"wall-thickness", 13}}}) {
    const Recording fine = record(heart::ParametricHeart(heart::parametersFrom(dials)),
                                  heart::View::a4c, 4, heart::KeyframeSpacing::even),
                    coarse = coarseSurfaces(fine);
    EXPECT_EQ(coarse.levels, 0);
    for (std::size_t p = 0; p < fine.parts.size(); ++p) {
      const RecordedPart& part = fine.parts[p];
      if (part.kind.membrane) continue;
      for (std::size_t k = 0; k < part.control_m.size(); ++k)
        EXPECT_NEAR(heart::volumeOf(coarse.parts[p].control_m[k], part.faces) / part.volume_m3[k],
                    1, 1e-3)
            << part.kind.name;
    }
    for (const char* name : {"lv_cavity", "lv_wall", "la", "rv_cavity"}) {
      const std::vector<double> off_m = distances(coarse.part(name), fine.part(name));
      const double p95_mm = 1e3 * off_m[off_m.size() * 95 / 100];
      std::printf("  %-9s median %.3f p95 %.3f max %.3f mm\n", name, 1e3 * off_m[off_m.size() / 2],
                  p95_mm, 1e3 * off_m.back());
      EXPECT_LT(p95_mm, 0.15) << name;
    }
  }
}

}  // namespace
}  // namespace echocine::coarse_surfaces_law
