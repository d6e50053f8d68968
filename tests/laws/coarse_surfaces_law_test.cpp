// Hearts of a quarter of the triangles against the refined ones: volumes and places of surfaces.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "motion/heart/coarse_surfaces.h"
#include "motion/heart/control_mesh.h"
#include "support/bind_to_surface.h"
#include "support/recorded_heart.h"

namespace echocine::coarse_surfaces_law {
namespace {

using heart::RecordedPart;
using heart::Recording;

// Distances in metres of every 32nd refined vertex from the coarse surface, ascending, at the first
// keyframe.
std::vector<double> distances(const RecordedPart& coarse, const RecordedPart& fine) {
  const std::vector<Vec3d>& points = coarse.control_m.front();
  const support::Mesh refined = support::subdivided({fine.control_m.front(), fine.faces});
  std::vector<double> out;
  for (std::size_t i = 0; i < refined.points.size(); i += 32) {
    double square = 1;
    for (const Triangle& t : coarse.faces)
      square = std::min(
          square, nearestOn(points[t[0]], points[t[1]], points[t[2]], refined.points[i]).distance2);
    out.push_back(std::sqrt(square));
  }
  std::sort(out.begin(), out.end());
  return out;
}

// A vertex at the control point or at its refined place changes volumes by 1 to 3 %.
TEST(CoarseSurfacesLaw, VolumesAndPlacesAreThoseOfTheRefinedHeart) {
  for (const support::Dials& dials : {support::Dials{},
                                      {{"ef", 0.25}, {"edv", 230}, {"ellipticity", 0.2}},
                                      {{"ef", 0.72}, {"edv", 75}, {"wall-thickness", 13}}}) {
    const Recording& fine = support::recordedHeart(dials, 4).recording;
    const Recording coarse = coarseSurfaces(fine);
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
