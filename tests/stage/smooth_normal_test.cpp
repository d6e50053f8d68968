// Interpolated normals at crossings: where they serve, and where the facet's own must.

#include "geometry/smooth_normal.h"

#include <gtest/gtest.h>

#include "support/plain_scene.h"
#include "support/surfaces.h"
#include "trace/interface_law.h"

namespace echocine {
namespace {

using namespace support;

TEST(SmoothNormal, FacetStandsInWhereTheValueFacesTheOtherWayOrIsNothing) {
  const Vec3d facet{0.6, 0, -0.8}, along{0, 0, 1};
  EXPECT_EQ(facingNormal({0, 0, -2}, along, facet), (Vec3d{0, 0, -1}));
  EXPECT_EQ(facingNormal({0, 0, 1}, along, facet), facet);
  EXPECT_EQ(facingNormal({1, 0, 0}, along, facet), facet);  // exactly grazing
  EXPECT_EQ(facingNormal({0, 0, 0}, along, facet), facet);
  EXPECT_EQ(facingNormal({0, 0, -1}, along, {1, 0, 0}), (Vec3d{1, 0, 0}));
}

// Whatever the ray, the value is that of the barycentric weights at the point that is crossed.
TEST(SmoothNormal, RunsLinearlyOverTheFacet) {
  RandomVectors random(5);
  const std::array<Vec3f, 3> n{Vec3f{0.6f, 0, -0.8f}, Vec3f{0, 0.6f, -0.8f}, Vec3f{0, 0, -1}};
  const std::array<Vec3f, 3> p{Vec3f{0, 0, 1}, Vec3f{0, 1, 1}, Vec3f{1, 0, 1}};
  int crossed = 0;
  for (int i = 0; i < 200; ++i) {
    const double b = random.number(0.05, 0.45), c = random.number(0.05, 0.45);
    const Ray ray = rayFromTo({random.number(-1, 1), random.number(-1, 1), -1}, {c, b, 1});
    const RayPlanes planes(ray);
    auto crossing = crossTriangle(planes, p[0], p[1], p[2], SurfaceId{0}, 0);
    if (!crossing) continue;
    ++crossed;
    double v[3];
    Vec3d q[3];
    for (std::size_t k = 0; k < 3; ++k) {
      q[k] = toDouble(p[k]);
      v[k] = dot(planes.v_axis, q[k] - planes.origin);
    }
    makeSmooth(planes, *cutTriangle(q[0], q[1], q[2], v[0], v[1], v[2]),
               cutNormals(n, v[0], v[1], v[2]), *crossing);
    const Vec3d expected =
        normalised((1 - b - c) * toDouble(n[0]) + b * toDouble(n[1]) + c * toDouble(n[2]));
    EXPECT_LT(length(crossing->normal - expected), 1e-7);
    EXPECT_LT(length(crossing->facet_normal - Vec3d{0, 0, -1}), 1e-7);
  }
  EXPECT_GT(crossed, 190);
}

// Into a faster medium at grazing incidence a smooth normal tilted off the facet's would bend
// the ray back over the facet; it must go on below it.
TEST(SmoothNormal, ABentRayStaysOnTheSideOfTheFacetToWhichItCrossed) {
  Scene scene = plainScene({medium("out", 1000, 1500), medium("in", 1000, 1560)});
  scene.effects.refraction = Switch::on;
  addStructure(scene, 1, 1);
  TraceSettings settings(scene, planEffects(scene));
  settings.refraction = true;
  int mended = 0;
  for (double facet_deg = 60; facet_deg < 89; facet_deg += 1)
    for (double tilt_deg = -20; tilt_deg <= 20; tilt_deg += 1) {
      const auto normalAt = [](double deg) {
        const double a = radiansFromDegrees(deg);
        return Vec3d{std::sin(a), 0, -std::cos(a)};
      };
      Crossing crossing{0.03, normalAt(facet_deg), SurfaceId{0}, 0, true};
      const Vec3d facet = crossing.normal;
      crossing.facet_normal = facet;
      crossing.normal = facingNormal(normalAt(facet_deg + tilt_deg), {0, 0, 1}, facet);
      LineTrace trace;
      LineWalker walker(settings, kDepthwards, {}, trace);
      walker.advance({{crossing}, {}});
      const auto plain = refracted({0, 0, 1}, crossing.normal, 1500, 1560);
      if (!plain) continue;  // total reflection
      const bool back = dot(*plain, facet) > 0;
      EXPECT_EQ(trace.segments.size(), back ? 2u : 1u);  // straight to the end, or up to the bend
      EXPECT_EQ(walker.query().ray.direction, back ? (Vec3d{0, 0, 1}) : *plain);
      mended += back;
    }
  EXPECT_GT(mended, 0);  // the case occurs
}

}  // namespace
}  // namespace echocine
