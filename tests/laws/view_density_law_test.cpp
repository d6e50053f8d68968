// Views do not depend on how finely a heart is meshed: the same surfaces with a part of their
// faces split give the same poses, and an ellipsoid has its own axis.

#include <gtest/gtest.h>

#include "motion/heart/heart_scene.h"
#include "motion/views/contact.h"
#include "motion/views/long_axis.h"
#include "scene/view_names.h"
#include "support/measured.h"
#include "support/recorded_heart.h"
#include "support/view_poses.h"

namespace echocine {
namespace {

using namespace support;
using Surfaces = std::vector<RoleSurface>;

// The same surface with each face that `chosen` picks by its middle in four, `times` times.
template <typename Chosen>
RoleSurface split(const RoleSurface& surface, int times, const Chosen& chosen) {
  RoleSurface now = surface;
  for (int i = 0; i < times; ++i) {
    RoleSurface next{now.role, now.name, now.points_m, {}};
    for (const Triangle& t : now.triangles) {
      const Vec3d a = now.points_m[t[0]], b = now.points_m[t[1]], c = now.points_m[t[2]];
      if (!chosen((1.0 / 3) * (a + b + c))) {
        next.triangles.push_back(t);
        continue;
      }
      const auto first = static_cast<std::uint32_t>(next.points_m.size());
      for (const Vec3d p : {0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)})
        next.points_m.push_back(p);
      const std::uint32_t ab = first, bc = first + 1, ca = first + 2;
      for (const Triangle& part : {Triangle{t[0], ab, ca}, Triangle{t[1], bc, ab},
                                   Triangle{t[2], ca, bc}, Triangle{ab, bc, ca}})
        next.triangles.push_back(part);
    }
    now = std::move(next);
  }
  return now;
}

// Poses of all views, with and without a half of the heart meshed four or sixteen times as finely.
void expectTheSame(const Surfaces& heart, bool has_aorta, const std::string& what) {
  const HeartMarks marks = marksIn(heart);
  support::Largest apart_mm("origin of a view", "mm");
  Vec3d middle{};
  for (const RoleSurface& s : heart)
    middle = middle + (1.0 / static_cast<double>(heart.size())) * meanPoint(s.points_m);
  for (const Vec3d direction : {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{0, 0, 1}}) {
    Surfaces finer;
    for (const RoleSurface& s : heart)
      finer.push_back(split(s, 1, [&](Vec3d p) { return dot(p - middle, direction) > 0; }));
    const HeartMarks again = marksIn(finer);
    EXPECT_LT(length(again.frame.apex - marks.frame.apex), 0.3e-3) << what << ", apex";
    for (const ViewName& name : viewNames()) {
      if (name.view == View::psax_base && !has_aorta) continue;
      const ProbePose pose = poseIn(name.view, again), wanted = poseIn(name.view, marks);
      SCOPED_TRACE(what + ", " + name.key);
      EXPECT_LT(apart_mm(1e3 * length(pose.apex - wanted.apex)), 0.3);
      EXPECT_NEAR(pose.depth_m, wanted.depth_m, 0.3e-3);
      // At the depth of the heart's far side.
      EXPECT_LT(length(pose.axis - wanted.axis) * wanted.depth_m, 0.6e-3);
      EXPECT_LT(length(pose.lateral - wanted.lateral) * wanted.depth_m, 0.6e-3);
    }
  }
}

TEST(ViewDensityLaw, AParametricHeartMeshedFinerInPartHasTheSameViews) {
  const heart::Recording& recording = recordedHeart({}, 4).recording;
  Surfaces surfaces;
  for (const heart::RecordedPart& part : recording.parts)
    if (const Role role = guessRole(part.kind.name);
        role != Role::none && role != Role::surroundings)
      surfaces.push_back({role, part.kind.name, part.control_m.front(), part.faces});
  expectTheSame(surfaces, true, "parametric");
}

TEST(ViewDensityLaw, RealHeartsMeshedFinerInPartHaveTheSameViews) {
  if (!realHeartsThere()) GTEST_SKIP() << "no real hearts beside the project";
  expectTheSame(patientHeart().surfaces, true, "patient");
}

// A prolate ellipsoid with half-axes 2, 2 and 4 cm, base at (0, 0, -4): tip, axis and length in
// closed form, whichever side of it is meshed finely.
TEST(ViewDensityLaw, AnEllipsoidHasItsOwnAxis) {
  const heart::SphereMesh& sphere = heart::geodesicSphere(12);
  RoleSurface surface{Role::lv_cavity, "ellipsoid", {}, sphere.faces};
  for (const Vec3d d : sphere.directions)
    surface.points_m.push_back({2e-2 * d.x, 2e-2 * d.y, 4e-2 * d.z});
  const auto anywhere = [](Vec3d) { return true; };
  for (const auto& finer : {split(surface, 1, [](Vec3d p) { return p.x > 0; }),
                            split(surface, 2, [](Vec3d p) { return p.y > 0 && p.z > 0; }),
                            split(surface, 1, anywhere)}) {
    const Facets facets = facetsOf({finer}, Role::lv_cavity);
    const Vec3d axis = principalAxis(facets);
    EXPECT_LT(std::hypot(axis.x, axis.y) * 8e-2, 0.1e-3);
    EXPECT_LT(length(middleOf(facets)), 0.1e-3);
    const VentricleAxis found = axisFromBase(facets, {0, 0, -4e-2});
    EXPECT_LT(length(found.apex - Vec3d{0, 0, 4e-2}), 0.3e-3);
  }
}

// Two plates 1 mm apart over a square of 2 cm: they touch in the middle of that square.
TEST(ViewDensityLaw, PlatesTouchInTheirMiddleHoweverMeshed) {
  const RoleSurface plate{Role::la,
                          "plate",
                          {{0, 0, 0}, {2e-2, 0, 0}, {2e-2, 2e-2, 0}, {0, 2e-2, 0}},
                          {{0, 1, 2}, {0, 2, 3}}};
  RoleSurface wide = plate;
  wide.role = Role::ra;
  for (Vec3d& p : wide.points_m) p = Vec3d{3 * p.x - 2e-2, 3 * p.y - 2e-2, 1e-3};
  for (const int times : {0, 3}) {
    const RoleSurface fine = split(plate, times, [](Vec3d p) { return p.x < 5e-3; });
    const Contact contact = contactOf(facetsOf({fine}, Role::la), facetsOf({wide}, Role::ra), 1e-4);
    EXPECT_NEAR(contact.gap, 1e-3, 1e-9);
    EXPECT_NEAR(contact.middle.x, 1e-2, 0.3e-3);
    EXPECT_NEAR(contact.middle.y, 1e-2, 0.3e-3);
  }
}

}  // namespace
}  // namespace echocine
