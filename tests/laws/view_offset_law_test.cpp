// One definition of a view: the truth measures no offset for a probe that a view has placed, and
// the planted offset for one that was moved by hand.

#include <gtest/gtest.h>

#include <cmath>

#include "motion/heart/heart_scene.h"
#include "motion/surfaces/probe_placement.h"
#include "motion/surfaces/rest_marks.h"
#include "scene/view_names.h"
#include "support/measured.h"
#include "support/real_hearts.h"
#include "support/recorded_heart.h"
#include "support/scene_text.h"
#include "truth/view_offset.h"

namespace echocine {
namespace {

using namespace support;

ViewOffset offsetOf(const Scene& scene) {
  const MeshMotion motion(scene);
  const auto rest = restMarks(scene, motion);
  if (!rest) throw std::runtime_error("no heart");
  SurfaceFrame frame;
  motion.frameAt(rest->phase, frame, false);
  const auto cavity = index(*structureOf(scene, Role::lv_cavity));
  return viewOffset(rest->heart, motion.surfaces()[cavity], frame.positions_m[cavity]);
}

struct OffsetSizes {
  support::Largest rotation_deg{"rotation", "deg"}, shift_mm{"shift", "mm"};
};

void expectNone(const ViewOffset& offset, View view, const std::string& what, OffsetSizes& sizes) {
  SCOPED_TRACE(what + ", " + keyOf(view));
  EXPECT_STREQ(offset.label, keyOf(view));
  EXPECT_LT(std::abs(offset.tilt_deg), 0.5);
  EXPECT_LT(std::abs(sizes.rotation_deg(offset.rotation_deg.value_or(0))), 0.5);
  EXPECT_LT(std::abs(sizes.shift_mm(offset.shift_mm)), 0.5);
  EXPECT_LT(std::abs(offset.foreshortening_mm.value_or(0)), 0.5);
}

TEST(ViewOffsetLaw, ParametricHeartsHaveNoneInTheirOwnViews) {
  OffsetSizes sizes;
  for (const Dials& dials :
       {Dials{}, Dials{{"edv", 200}, {"ef", 0.3}}, Dials{{"body-scale", 0.6}}}) {
    const RecordedHeart& heart = recordedHeart(dials, 4);
    heart::Recording recording = heart.recording;
    for (const ViewName& name : viewNames()) {
      recording.pose = heart::poseOf(name.view, recording);
      expectNone(offsetOf(heart::sceneOf(name.view, heart.parameters, recording)), name.view,
                 "parametric", sizes);
    }
  }
}

// A scene of a real heart's meshes, still.
Scene sceneOf(const RealHeart& heart, View view) {
  SceneText text;
  text.motion = {{"mesh_unit", "\"m\""}};
  text.probe.erase("apex");
  text.probe.erase("axis");
  text.probe.erase("lateral");
  text.probe["view"] = std::string("\"") + keyOf(view) + "\"";
  NamedMeshes meshes;
  for (std::size_t s = 0; s < heart.surfaces.size(); ++s) {
    const RoleSurface& surface = heart.surfaces[s];
    meshes.emplace(surface.name, std::make_shared<TriangleMesh>(
                                     TriangleMesh{surface.points_m, surface.triangles, {}, {}}));
    // Open sheets are accepted as membranes; only the cavity needs its volume.
    const bool closed = surface.role == Role::lv_cavity;
    text.structures += "[[structure]]\nname = \"" + surface.name +
                       "\"\nmedium = \"myocardium\"\nkeyframes = [\"" + surface.name +
                       "\"]\nrole = \"" + nameOf(surface.role) + "\"\n" +
                       (closed ? "priority = 1" : "membrane = true") + "\n";
  }
  return placed(parseScene(text.text(), "in memory", meshes));
}

TEST(ViewOffsetLaw, RealHeartsHaveNoneWhereAViewPlacesTheProbe) {
  if (!realHeartsThere()) GTEST_SKIP() << "no real hearts beside the project";
  OffsetSizes sizes;
  for (const RealHeart& heart : {patientHeart(), wholeHeart()})
    for (const ViewName& name : viewNames())
      expectNone(offsetOf(sceneOf(heart, name.view)), name.view, heart.name, sizes);
}

TEST(ViewOffsetLaw, PlantedOffsetsAreMeasured) {
  const RecordedHeart& heart = recordedHeart({}, 4);
  heart::Recording recording = heart.recording;
  for (const View view : {View::a4c, View::a2c, View::plax, View::psax_mid}) {
    SCOPED_TRACE(keyOf(view));
    recording.pose = heart::poseOf(view, recording);
    Scene scene = heart::sceneOf(view, heart.parameters, recording);
    const Pose straight = scene.probe.pose;
    scene.probe.pose.origin = straight.origin + 4e-3 * straight.y_axis;
    EXPECT_NEAR(std::abs(offsetOf(scene).shift_mm), 4, 0.1);
    EXPECT_STREQ(offsetOf(scene).label, keyOf(view));
    if (view == View::psax_mid) continue;
    // About the long axis itself, through the ventricle's middle.
    const auto marks = restMarks(scene, MeshMotion(scene))->heart.frame;
    const Vec3d axis = straight.x_axis * marks.apical.x + straight.y_axis * marks.apical.y +
                       straight.z_axis * marks.apical.z;
    const auto turned = [&](Vec3d v) {
      const double c = std::cos(0.2), s = std::sin(0.2);
      return c * v + s * cross(axis, v) + (1 - c) * dot(axis, v) * axis;
    };
    scene.probe.pose = straight;
    scene.probe.pose.x_axis = turned(straight.x_axis);
    scene.probe.pose.y_axis = turned(straight.y_axis);
    scene.probe.pose.z_axis = turned(straight.z_axis);
    EXPECT_NEAR(std::abs(*offsetOf(scene).rotation_deg), 0.2 * 180 / std::numbers::pi, 0.1);
  }
}

}  // namespace
}  // namespace echocine
