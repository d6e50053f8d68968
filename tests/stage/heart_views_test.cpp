// Every standard view shows its defining structures, in the conventional orientation.

#include <gtest/gtest.h>

#include "support/recorded_heart.h"

namespace echocine {
namespace {

using namespace support;
using heart::View;

const std::vector<heart::Part>& partsAtRest() {
  static const std::vector<heart::Part> parts = defaultHeart().at(0);
  return parts;
}
Mesh partAtRest(const char* name) {
  const heart::Part& part = partOf(partsAtRest(), name);
  return {part.points, part.faces};
}

heart::ProbePose poseOnce(View view) {
  static std::map<View, heart::ProbePose> poses;
  const auto known = poses.find(view);
  if (known != poses.end()) return known->second;
  return poses[view] = heart::poseOf(view, recordedHeart({}, 4).recording);
}

// A view of the heart: image coordinates of points, x to the right, z deep, y out of the plane.
struct Image {
  heart::ProbePose pose;
  explicit Image(View view) : pose(poseOnce(view)) {}

  Vec3d of(Vec3d point) const {
    const Pose frame{pose.apex, pose.lateral, cross(pose.axis, pose.lateral), pose.axis};
    return frame.fromWorld(point);
  }
  // The middle of what the imaging plane cuts of a part, within 3 mm.
  Vec3d sliceOf(const char* part) const {
    std::vector<Vec3d> near;
    for (const Vec3d p : partAtRest(part).points)
      if (std::abs(of(p).y) < 3e-3) near.push_back(of(p));
    EXPECT_GT(near.size(), 8u) << part;
    return near.empty() ? Vec3d{} : meanOf(near);
  }
};

constexpr View kAllViews[] = {View::a4c,       View::a2c,       View::a3c,
                              View::plax,      View::psax_base, View::psax_mid,
                              View::psax_apex, View::subcostal, View::tee_4c};

TEST(HeartViews, HaveKeysThatLeadBackToThem) {
  EXPECT_EQ(heart::viewNames().size(), std::size(kAllViews));
  for (const View view : kAllViews) EXPECT_EQ(heart::viewOf(keyOf(view)), view);
  EXPECT_EQ(heart::viewOf("a5c"), std::nullopt);
}

TEST(HeartViews, TheProbeStandsOutsideTheHeartWithOrthonormalAxes) {
  const Mesh sac = partAtRest("pericardium");
  for (const View view : kAllViews) {
    const heart::ProbePose pose = Image(view).pose;
    EXPECT_NEAR(length(pose.axis), 1, 1e-12) << keyOf(view);
    EXPECT_NEAR(length(pose.lateral), 1, 1e-12) << keyOf(view);
    EXPECT_NEAR(dot(pose.axis, pose.lateral), 0, 1e-12) << keyOf(view);
    EXPECT_LT(windingNumber(sac, pose.apex), 0.01) << keyOf(view);
    double clearance_m = 1;
    for (const Vec3d p : sac.points) clearance_m = std::min(clearance_m, length(p - pose.apex));
    EXPECT_GT(clearance_m, view == View::tee_4c ? 4e-3 : 8e-3) << keyOf(view);
    EXPECT_LT(clearance_m, 60e-3) << keyOf(view);
  }
}

TEST(HeartViews, TheWholeHeartIsWithinTheDepth) {
  for (const View view : kAllViews) {
    const Image image(view);
    double deepest_m = 0;
    int within = 0, count = 0;
    for (const Vec3d p : partAtRest("pericardium").points) {
      const Vec3d at = image.of(p);
      if (std::abs(at.y) > 5e-3) continue;
      ++count;
      const double angle_deg = std::abs(std::atan2(at.x, at.z)) * 180 / std::numbers::pi;
      if (angle_deg > 0.5 * image.pose.sector_deg) continue;
      ++within;
      deepest_m = std::max(deepest_m, length(at));
    }
    EXPECT_GT(count, 10) << keyOf(view);
    EXPECT_LT(deepest_m, image.pose.depth_m) << keyOf(view);
    EXPECT_GT(deepest_m, 0.7 * image.pose.depth_m) << keyOf(view);  // nor is it lost in the picture
    // From the oesophagus the atria are wider than the sector.
    EXPECT_GT(within, (view == View::tee_4c ? 0.45 : 0.6) * count) << keyOf(view);
  }
}

TEST(HeartViews, FourChambersStandTheUsualWayRound) {
  const Image image(View::a4c);
  const Vec3d lv = image.sliceOf("lv_cavity"), rv = image.sliceOf("rv_cavity"),
              la = image.sliceOf("la"), ra = image.sliceOf("ra");
  EXPECT_GT(lv.x, rv.x + 0.02);
  EXPECT_GT(la.x, ra.x + 0.02);
  EXPECT_GT(la.z, lv.z + 0.03);  // ventricles next to the probe
  EXPECT_GT(ra.z, rv.z + 0.03);
}

TEST(HeartViews, TheOtherApicalViewsHaveTheVentricleNextToTheProbe) {
  for (const View view : {View::a2c, View::a3c}) {
    const Image image(view);
    EXPECT_GT(image.sliceOf("la").z, image.sliceOf("lv_cavity").z + 0.03) << keyOf(view);
    const Vec3d apex = image.of(defaultHeart().landmarksAt(0).apex);
    EXPECT_LT(std::abs(apex.x), 0.01) << keyOf(view);
  }
  const Image three(View::a3c);
  EXPECT_GT(three.sliceOf("aorta").x, three.sliceOf("la").x + 0.01);
  EXPECT_GT(Image(View::a2c).of(0.05 * Vec3d{0.5, 0.866, 0}).x,
            Image(View::a2c).of(-0.05 * Vec3d{0.5, 0.866, 0}).x);  // the anterior wall right
}

TEST(HeartViews, TheParasternalLongAxisHasTheAortaRightAndTheAtriumDeep) {
  const Image image(View::plax);
  const heart::Landmarks marks = defaultHeart().landmarksAt(0);
  EXPECT_GT(image.of(marks.aortic).x, image.of(marks.apex).x + 0.05);
  EXPECT_GT(image.sliceOf("la").z, image.sliceOf("aorta").z + 0.01);
  EXPECT_LT(image.sliceOf("rv_cavity").z, image.sliceOf("lv_cavity").z);
}

// The beam's middle meets the ventricle's long axis at the tips of the mitral leaflets, a sixth of
// the way from the ring to the apex.
TEST(HeartViews, TheParasternalLongAxisIsAimedAtTheTipsOfTheLeaflets) {
  const Image image(View::plax);
  const heart::Landmarks marks = defaultHeart().landmarksAt(0);
  const double ring = image.of(marks.mitral).x, apex = image.of(marks.apex).x;
  EXPECT_NEAR(ring / (ring - apex), 1.0 / 6, 0.04);
}

TEST(HeartViews, ShortAxesHaveTheRightVentricleLeftAndLookFromTheApex) {
  for (const View view : {View::psax_mid, View::psax_apex}) {
    const Image image(view);
    EXPECT_LT(image.sliceOf("rv_cavity").x, image.sliceOf("lv_cavity").x - 0.005) << keyOf(view);
    // Towards the viewer, right-handed with the picture's right and down: -y of the image.
    EXPECT_GT(dot(cross(image.pose.lateral, image.pose.axis), Vec3d{0, 0, -1}), 0.99)
        << keyOf(view);
  }
  const Image base(View::psax_base);
  EXPECT_LT(base.sliceOf("ra").x, base.sliceOf("la").x);
  EXPECT_GT(base.sliceOf("la").z, base.sliceOf("aorta").z);
}

TEST(HeartViews, SubcostalHasTheRightHeartNextToTheProbe) {
  const Image image(View::subcostal);
  EXPECT_LT(image.sliceOf("rv_cavity").z, image.sliceOf("lv_cavity").z);
  EXPECT_GT(image.of(defaultHeart().landmarksAt(0).apex).x, 0);
}

// What a view is named after is cut through its middle.
TEST(HeartViews, WhatDefinesAViewLiesInItsPlane) {
  const heart::Landmarks marks = defaultHeart().landmarksAt(0);
  const auto aside_m = [](View view, Vec3d point) { return std::abs(Image(view).of(point).y); };
  EXPECT_LT(aside_m(View::a4c, marks.mitral), 3e-3);
  EXPECT_LT(aside_m(View::a4c, marks.apex), 3e-3);
  EXPECT_LT(aside_m(View::a2c, marks.mitral), 3e-3);
  EXPECT_LT(aside_m(View::a3c, marks.mitral), 3e-3);
  EXPECT_LT(aside_m(View::a3c, marks.aortic), 3e-3);
  EXPECT_LT(aside_m(View::plax, marks.mitral), 3e-3);
  EXPECT_LT(aside_m(View::plax, marks.aortic), 3e-3);
  EXPECT_LT(aside_m(View::psax_base, marks.aortic), 3e-3);
  // Within its ring a valve's plane may pass beside the centre.
  EXPECT_LT(aside_m(View::a4c, marks.tricuspid), marks.tricuspid_radius_m);
  EXPECT_LT(aside_m(View::subcostal, marks.mitral), marks.mitral_radius_m);
  EXPECT_LT(aside_m(View::subcostal, marks.tricuspid), marks.tricuspid_radius_m);
  for (const char* muscle : {"papillary_anterolateral", "papillary_posteromedial"})
    EXPECT_LT(std::abs(Image(View::psax_mid).sliceOf(muscle).y), 3e-3);
}

// A tenth of a millimetre is less than a pixel; a step of five would be a jump of the picture.
TEST(HeartViews, TheDepthFollowsTheEjectionFractionWithoutSteps) {
  double last_m = 0;
  for (int i = 0; i <= 6; ++i) {
    const heart::ParametricHeart model(heart::parametersFrom({{"ef", 0.60 - 0.01 * i}}));
    const double depth_m = heart::poseOf(View::a4c, heart::recordBeat(model, View::a4c, 4)).depth_m;
    if (i > 0) {
      EXPECT_NEAR(depth_m, last_m, 1e-3) << i;
      EXPECT_NE(depth_m, last_m) << i;
    }
    last_m = depth_m;
  }
}

TEST(HeartViews, AreAimedAtAnyHeart) {
  const heart::ParametricHeart small(heart::parametersFrom({{"body-scale", 0.6}}));
  const heart::Landmarks marks = small.landmarksAt(0);
  const heart::ProbePose pose = heart::poseOf(View::a4c, heart::recordBeat(small, View::a4c, 4));
  EXPECT_LT(pose.depth_m, 0.75 * Image(View::a4c).pose.depth_m);
  EXPECT_LT(std::abs(dot(marks.mitral - pose.apex, cross(pose.axis, pose.lateral))), 2e-3);
}

}  // namespace
}  // namespace echocine
