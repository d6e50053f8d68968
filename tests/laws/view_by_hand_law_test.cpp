// Views found from real hearts' meshes against probes placed by hand.

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "scene/view_names.h"
#include "support/real_hearts.h"
#include "support/view_poses.h"

namespace echocine {
namespace {

using namespace support;

// The last of a heart's surface that a ray meets, m from its start.
double surfaceAlong_m(const RealHeart& heart, Vec3d from, Vec3d direction) {
  double last_m = 0;
  for (std::size_t s = 0; s < heart.surfaces.size(); ++s) {
    const std::vector<Vec3d>& points = heart.surfaces[s].points_m;
    for (const Triangle& t : heart.triangles[s]) {
      const Vec3d a = points[t[0]] - from, b = points[t[1]] - from, c = points[t[2]] - from;
      const double sides[] = {dot(direction, cross(a, b)), dot(direction, cross(b, c)),
                              dot(direction, cross(c, a))};
      const auto [low, high] = std::minmax_element(std::begin(sides), std::end(sides));
      if (*low < 0 && *high > 0) continue;
      const Vec3d normal = cross(b - a, c - a);
      if (const double slope = dot(direction, normal); slope != 0)
        last_m = std::max(last_m, dot(a, normal) / slope);
    }
  }
  return last_m;
}

// Placed by hand, as a sonographer says it (Mitchell et al., J. Am. Soc. Echocardiogr. 32, 1-64,
// 2019). Apical: through the apex with the valves' middles in the plane. Parasternal: from in
// front, the long axis level; 15 mm behind the mitral ring, where its leaflets end, or half-way to
// the apex.
ProbePose byHand(View view, const RealHeart& heart) {
  const Vec3d axis = normalised(heart.apex - heart.mitral);
  const auto across = [&](Vec3d v) { return normalised(v - dot(v, axis) * axis); };
  const Vec3d left = across(heart.mitral - heart.tricuspid), front = across(cross(axis, left)),
              out = across(heart.aortic - heart.mitral);
  const Vec3d crux = 0.65 * heart.mitral + 0.35 * heart.tricuspid;
  const double skin_m = 0.025;  // muscle and chest before the apex
  const auto from = [&](Vec3d target, Vec3d to_right) {
    const Vec3d down = normalised(target - heart.apex);
    return ProbePose{heart.apex - skin_m * down, down,
                     normalised(to_right - dot(to_right, down) * down)};
  };
  // On the chest, 22 mm before what nine rays from 10 by 10 mm of the probe's face meet first.
  const auto before = [&](Vec3d target, Vec3d to_right) {
    double off_m = 0;
    for (const double right_m : {-0.005, 0.0, 0.005})
      for (const double up_m : {-0.005, 0.0, 0.005})
        off_m = std::max(
            off_m,
            0.022 + surfaceAlong_m(heart, target + right_m * to_right + up_m * cross(out, to_right),
                                   out));
    return ProbePose{target + off_m * out, -out, to_right};
  };
  if (view == View::a4c) return from(crux, left);
  if (view == View::a2c) return from(heart.mitral, 0.5 * left + 0.866 * front);
  if (view == View::a3c) return from(0.5 * (heart.mitral + heart.aortic), out);
  if (view == View::plax) return before(heart.mitral + 0.015 * axis, -axis);
  if (view == View::psax_mid)
    return before(0.5 * (heart.mitral + heart.apex), across(cross(out, axis)));
  ADD_FAILURE() << "no hand has placed it";
  return {};
}

TEST(ViewByHandLaw, RealHeartsAreSeenAsByHand) {
  if (!realHeartsThere()) GTEST_SKIP() << "no real hearts beside the project";
  for (const RealHeart& heart : {patientHeart(), wholeHeart(), fourChamberHeart()})
    for (const View view : {View::a4c, View::a2c, View::a3c, View::plax, View::psax_mid}) {
      if (!heart.has_aorta && view != View::a4c && view != View::a2c) continue;
      expectNear(poseIn(view, heart.surfaces), byHand(view, heart), 10, 10,
                 heart.name + ", " + keyOf(view));
    }
}

// The patient lies in a scanner: x to the left, y to the back, z up. Under the ribs' tip a probe
// looks up, back and to the left, from below the heart and from its front half.
TEST(ViewByHandLaw, ASubcostalProbeStandsBelowAndBeforeAPatientsHeart) {
  if (!realHeartsThere()) GTEST_SKIP() << "no real hearts beside the project";
  const RealHeart heart = patientHeart();
  const ProbePose pose = poseIn(View::subcostal, heart.surfaces);
  EXPECT_GT(pose.axis.x, 0.3);
  EXPECT_GT(pose.axis.y, 0.3);
  EXPECT_GT(pose.axis.z, 0.3);
  double lowest_m = 1, front_m = 1, back_m = -1;
  for (const RoleSurface& surface : heart.surfaces)
    for (const Vec3d p : surface.points_m) {
      lowest_m = std::min(lowest_m, p.z);
      front_m = std::min(front_m, p.y);
      back_m = std::max(back_m, p.y);
    }
  EXPECT_LT(pose.apex.z, lowest_m);
  EXPECT_LT(pose.apex.y, 0.5 * (front_m + back_m));
}

}  // namespace
}  // namespace echocine
