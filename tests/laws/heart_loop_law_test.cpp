// Loops of parametric hearts between their keyframes: the ejection fraction is the dialled one for
// any number of keyframes, and nothing is warned of.

#include <gtest/gtest.h>

#include "motion/heart/heart_scene.h"
#include "motion/mesh/surface_measure.h"
#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/motion_warnings.h"
#include "scene/role.h"
#include "scene/view_names.h"
#include "support/measured.h"
#include "support/recorded_heart.h"

namespace echocine {
namespace {

using namespace support;

constexpr int kInstants = 256;  // of a beat, as the truth looks at it

// Faces of a surface that look towards its middle: none of a star-shaped one.
int inwardFaces(const SurfaceTopology& surface, const std::vector<Vec3f>& points_m) {
  Vec3d middle{};
  for (const Vec3f p : points_m) middle = middle + toDouble(p);
  middle = (1.0 / static_cast<double>(points_m.size())) * middle;
  return static_cast<int>(
      std::count_if(surface.triangles.begin(), surface.triangles.end(), [&](const Triangle& t) {
        return !(dot(doubleArea(t, points_m), toDouble(points_m[t[0]]) - middle) > 0);
      }));
}

// Measures of a loop of kInstants frames.
struct Beat {
  double ejection_fraction = 0;
  int inward_faces = 0;  // of grooves and pericardium, in the worst frame
};

Beat beatOf(const Scene& scene) {
  const MeshMotion motion(scene);
  const SurfaceTopology& cavity = motion.surfaces()[index(*structureOf(scene, Role::lv_cavity))];
  SurfaceFrame frame;
  double least_m3 = 1, most_m3 = 0;
  Beat beat;
  for (int i = 0; i < kInstants; ++i) {
    motion.frameAt(static_cast<double>(i) / kInstants, frame, false);
    const double volume_m3 = motion.volumeIn(frame, cavity);
    least_m3 = std::min(least_m3, volume_m3);
    most_m3 = std::max(most_m3, volume_m3);
    for (const SurfaceTopology& surface : motion.surfaces()) {
      const std::string& name = scene.structures[index(surface.id)].name;
      if (name == "grooves" || name == "pericardium")
        beat.inward_faces =
            std::max(beat.inward_faces, inwardFaces(surface, frame.positions_m[index(surface.id)]));
    }
  }
  beat.ejection_fraction = 1 - least_m3 / most_m3;
  return beat;
}

std::vector<std::string> warningsOf(Scene scene) {
  scene.acquisition.frame_rate_hz = kInstants * scene.acquisition.heart_rate_hz;
  return motionWarnings(scene, MeshMotion(scene));
}

void expectAsDialled(const Dials& dials, int keyframes) {
  SCOPED_TRACE(std::to_string(keyframes) + " keyframes");
  const RecordedHeart& heart = recordedHeart(dials, keyframes);
  const Scene scene = heart::sceneOf(heart::View::a4c, heart.parameters, heart.recording);
  const Beat beat = beatOf(scene);
  const double off = beat.ejection_fraction - dials.at("ef");
  EXPECT_NEAR(Largest("EF off by", "")(off), 0, 0.003);
  EXPECT_EQ(beat.inward_faces, 0);
  EXPECT_EQ(warningsOf(scene), std::vector<std::string>{});
}

TEST(HeartLoopLaw, TheEjectionFractionIsTheDialledOneForAnyNumberOfKeyframes) {
  for (const int keyframes : {4, 5, 6, 8, 12, 24}) expectAsDialled({{"ef", 0.65}}, keyframes);
}

TEST(HeartLoopLaw, FailingFastAndTwistingHeartsKeepTheirs) {
  expectAsDialled({{"ef", 0.35}, {"edv", 160}, {"hr", 90}}, 7);
  expectAsDialled({{"ef", 0.70}, {"hr", 120}}, 6);
  expectAsDialled({{"ef", 0.60}, {"twist", 25}}, 4);
  expectAsDialled({{"ef", 0.45}, {"atrial-share", 0.5}}, 5);
}

TEST(HeartLoopLaw, NoViewOfAHeartIsWarnedOf) {
  const RecordedHeart& heart = recordedHeart({{"ef", 0.35}}, 24);
  heart::Recording recording = heart.recording;
  for (const ViewName& name : viewNames()) {
    recording.pose = heart::poseOf(name.view, recording);
    heart::surround(name.view, recording.pose, heart.model, recording);
    EXPECT_EQ(warningsOf(heart::sceneOf(name.view, heart.parameters, recording)),
              std::vector<std::string>{})
        << name.key;
  }
}

}  // namespace
}  // namespace echocine
