// A plane tilted out of the picture is found where it was planted.

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "fit/heart_family.h"
#include "fit/plane_tilt.h"
#include "frame/simulator.h"
#include "motion/surfaces/probe_placement.h"
#include "support/all_cases.h"
#include "support/drawn_heart.h"
#include "support/view_loops.h"

namespace echocine::fit {

using namespace echo;
namespace {

using namespace support;

// What lies on the tilted plane in the world lies on y = 0 of the tilted frame, as far from the
// apex and at the place in the plane that it was put at; and back is nothing.
TEST(CompareTilt, SurfacesAreSeenFromTheTiltedProbe) {
  for (const PlaneTilt tilt : {PlaneTilt{0.1, 0}, PlaneTilt{0, -0.15}, PlaneTilt{-0.12, 0.08}}) {
    const Pose pose = turnedAndTilted({}, tilt.rotate_rad, tilt.tilt_rad);
    const Vec3d in_plane{0.02, 0, 0.09};
    std::vector<SurfaceFrame> frames(1);
    frames[0].positions_m = {{toFloat(pose.toWorld(in_plane))}};
    tiltSurfaces(tilt, frames);
    const Vec3f seen = frames[0].positions_m[0][0];
    EXPECT_NEAR(seen.x, in_plane.x, 1e-8);
    EXPECT_NEAR(seen.y, 0, 1e-8);
    EXPECT_NEAR(seen.z, in_plane.z, 1e-8);
  }
  // Tilting takes depth towards elevation, rotating takes lateral towards elevation.
  EXPECT_NEAR(turnedAndTilted({}, 0, 0.1).z_axis.y, std::sin(0.1), 1e-12);
  EXPECT_EQ(turnedAndTilted({}, 0, 0.1).x_axis, (Vec3d{1, 0, 0}));
  EXPECT_NEAR(turnedAndTilted({}, 0.1, 0).x_axis.y, std::sin(0.1), 1e-12);
  EXPECT_EQ(turnedAndTilted({}, 0.1, 0).z_axis, (Vec3d{0, 0, 1}));
}

// A model whose larger chamber grows with the tilt, and beats more with the rotation.
ModelLoop changingWith(const PlaneTilt& tilt, double grow_m = 0) {
  return Phantom{.grow_m = grow_m + 4e-4 * (degreesFromRadians(tilt.tilt_rad) - 3),
                 .beat = 0.15 + 0.012 * (degreesFromRadians(tilt.rotate_rad) + 2)}
      .model();
}

TiltFound searched(const ModelDiscrepancy& d, double most_deg, double grow_m = 0) {
  return searchTilt([&](const PlaneTilt& tilt) { return changingWith(tilt, grow_m); }, d,
                    d.search(changingWith({}, grow_m)), most_deg);
}

const ModelDiscrepancy& drawnOnce() {
  static const ModelDiscrepancy d(draw(Phantom{}, {}, 20, 3), fromTheStart(), Phantom{}.model());
  return d;
}

// By two threads.
const TiltFound& searchedOnce(double most_deg) {
  static std::map<double, TiltFound> found;
  TiltFound& one = found[most_deg];
  if (one.planes == 0) withThreads(2, [&] { one = searched(drawnOnce(), most_deg); });
  return one;
}

constexpr double kWithin_deg = 10, kShort_deg = 1.5;

TEST(CompareTilt, TheLeastOfBothAnglesIsFound) {
  withThreads(2, [] {
    const ModelDiscrepancy& d = drawnOnce();
    const TiltFound found = searchedOnce(kWithin_deg);
    std::printf(
        "found %.2f and %.2f deg, confidence %.3f and %.3f, D %.4f, untilted %.4f, %d planes\n",
        degreesFromRadians(found.tilt.tilt_rad), degreesFromRadians(found.tilt.rotate_rad),
        found.tilt_confidence, found.rotate_confidence, found.found.discrepancy, found.untilted,
        found.planes);
    // D of a drawn heart is biased by half a millimetre, a degree and a quarter here.
    EXPECT_NEAR(degreesFromRadians(found.tilt.tilt_rad), 3, 2);
    // No place nearby is better, nor is the planted one.
    const auto valueAt = [&](double tilt_deg, double rotate_deg) {
      const PlaneTilt at{radiansFromDegrees(tilt_deg), radiansFromDegrees(rotate_deg)};
      return d.refine(changingWith(at), {found.found.pose}).discrepancy;
    };
    const double tilt = degreesFromRadians(found.tilt.tilt_rad),
                 rotate = degreesFromRadians(found.tilt.rotate_rad);
    for (const double step : {-1.0, 1.0}) {
      EXPECT_GT(valueAt(tilt + step, rotate), found.found.discrepancy);
      EXPECT_GT(valueAt(tilt, rotate + step), found.found.discrepancy);
    }
    EXPECT_GE(valueAt(3, -2), found.found.discrepancy);
    EXPECT_LT(found.found.discrepancy, found.untilted);
    EXPECT_FALSE(found.at_limit);
    // The search stays within the requested limit and reports that it ends there.
    const TiltFound& short_of = searchedOnce(kShort_deg);
    EXPECT_NEAR(degreesFromRadians(short_of.tilt.tilt_rad), kShort_deg, 1e-9);
    EXPECT_TRUE(short_of.at_limit);
    EXPECT_GE(short_of.found.discrepancy, found.found.discrepancy);
  });
}

// Along a dial the tilt makes good what the dial changes: D and tilt bend evenly, without steps.
TEST(CompareTilt, TiltAndDiscrepancyAreContinuousInADial) {
  if (!allCases()) GTEST_SKIP() << "set ECHOCINE_ALL_CASES for this sweep";
  withThreads(2, [] {
    const ModelDiscrepancy d(draw(Phantom{}, {}, 20, 33), fromTheStart(), Phantom{}.model());
    std::vector<TiltFound> found;
    for (int i = 0; i < 6; ++i) found.push_back(searched(d, 10, 1e-4 * i));
    for (std::size_t i = 1; i + 1 < found.size(); ++i)
      EXPECT_LT(std::abs(found[i - 1].found.discrepancy - 2 * found[i].found.discrepancy +
                         found[i + 1].found.discrepancy),
                0.002)
          << i;
    // 0.1 mm of growth are a quarter of a degree.
    for (std::size_t i = 1; i < found.size(); ++i)
      EXPECT_NEAR(degreesFromRadians(found[i].tilt.tilt_rad - found[i - 1].tilt.tilt_rad), -0.25,
                  0.25)
          << i;
  });
}

TEST(CompareTilt, ThreadsChangeNothing) {
  const double most_deg = allCases() ? kWithin_deg : kShort_deg;
  std::vector<TiltFound> found{searchedOnce(most_deg)};
  withThreads(1, [&] {
    const ModelDiscrepancy d(draw(Phantom{}, {}, 20, 3), fromTheStart(), Phantom{}.model());
    found.push_back(searched(d, most_deg));
  });
  EXPECT_EQ(found[0].tilt.tilt_rad, found[1].tilt.tilt_rad);
  EXPECT_EQ(found[0].tilt.rotate_rad, found[1].tilt.rotate_rad);
  EXPECT_EQ(found[0].found.discrepancy, found[1].found.discrepancy);
  EXPECT_EQ(found[0].planes, found[1].planes);
}

TEST(CompareTilt, AMonitorStopsTheSearch) {
  withThreads(2, [] {
    const ModelDiscrepancy& d = drawnOnce();
    Monitor monitor;
    monitor.keep_going = [] { return false; };
    EXPECT_THROW(searchTilt([](const PlaneTilt& tilt) { return changingWith(tilt); }, d,
                            d.search(Phantom{}.model()), 10, monitor),
                 JobError);
  });
}

Scene parametricHeart() {
  static const Scene scene = heart::heartScene(
      heart::parametersFrom({{"ef", 0.45}, {"edv", 150}, {"wall-thickness", 11}, {"hr", 72}}),
      View::a4c, 20, Look::scanner);
  return scene;
}

Scene held(Scene scene, double tilt_deg, double rotate_deg) {
  scene.probe.pose = turnedAndTilted(scene.probe.pose, radiansFromDegrees(rotate_deg),
                                     radiansFromDegrees(tilt_deg));
  return scene;
}

// Turning surfaces is holding the probe otherwise.
TEST(CompareTilt, ATiltedModelIsThatOfATiltedProbe) {
  withThreads(2, [] {
    const Scene scene = parametricHeart(), other = held(scene, 8, -6);
    const MeshMotion motion(scene), other_motion(other);
    const PlaneTilt tilt{radiansFromDegrees(8), radiansFromDegrees(-6)};
    const ModelLoop turned = TiltableModel(scene, motion, 4).at(tilt),
                    right = modelLoop(other, other_motion, 4),
                    untilted = modelLoop(scene, motion, 4);
    ASSERT_EQ(turned.frames.size(), right.frames.size());
    EXPECT_EQ(turned.systole, right.systole);
    for (std::size_t n = 0; n < right.frames.size(); ++n) {
      EXPECT_NEAR(bloodOf(turned, n), bloodOf(right, n), 1e-3 * bloodOf(right, n)) << n;
      EXPECT_GT(std::abs(bloodOf(untilted, n) - bloodOf(right, n)), 0.03 * bloodOf(right, n)) << n;
      std::size_t unlike = 0;
      for (std::size_t c = 0; c < right.frames[n].cells.size(); ++c)
        unlike += right.frames[n].cells[c].first != turned.frames[n].cells[c].first ? 1 : 0;
      EXPECT_LE(unlike, right.frames[n].cells.size() / 500) << n;
    }
  });
}

std::size_t verticesOf(const std::vector<SurfaceFrame>& frames) {
  std::size_t sum = 0;
  for (const auto& surface : frames.front().positions_m) sum += surface.size();
  return sum;
}

double lengthOf(const ModelFrame& frame) {
  double sum_m = 0;
  for (const BoundaryPoint& p : frame.boundary) sum_m += static_cast<double>(p.length_m);
  return sum_m;
}

// A family that was made for a tilt has all that the tilted plane cuts: one that was made for more
// says the same. Its patches differ, and so do the rounding of vertices, by micrometres, and the
// places where contours start.
TEST(CompareTilt, AFamilyKeepsWhatItsTiltsCut) {
  withThreads(2, [] {
    const HeartNodes hearts({{"hr", 72}}, {{"edv", 130, 170}}, 4, 2);
    const auto family = [&](double tilt_deg) {
      return HeartFamily(hearts, heart::View::a4c, {}, tilt_deg);
    };
    const HeartFamily enough = family(8), more = family(20);
    const PlaneTilt tilt{radiansFromDegrees(8), radiansFromDegrees(-8)};
    for (const double edv : {130.0, 150.0}) {
      const ModelLoop a = enough.at({edv}, tilt), b = more.at({edv}, tilt);
      for (std::size_t n = 0; n < a.frames.size(); ++n) {
        EXPECT_NEAR(bloodOf(a, n), bloodOf(b, n), 2e-4 * bloodOf(b, n)) << edv << " " << n;
        const double length_m = lengthOf(b.frames[n]);
        EXPECT_GT(length_m, 1.0);
        EXPECT_NEAR(lengthOf(a.frames[n]), length_m, 1e-2 * length_m) << edv << " " << n;
      }
      EXPECT_LT(verticesOf(enough.surfacesAt({edv})), verticesOf(more.surfacesAt({edv})));
    }
  });
}

// Under another speckle and look, by what ModelDiscrepancy looks at. The rotation is weakly
// determined: its confidence is about 0.1, and it is 2.7 degrees off where borders are lost.
TEST(CompareTilt, APlantedTiltIsFoundUnderAnotherLook) {
  withThreads(2, [] {
    const Simulator heart(parametricHeart());
    const ModelDiscrepancy d(scannedLoop(held(heart.scene(), -6, 0), 24, 3), fromTheStart(),
                             modelLoop(heart.scene(), heart.motion(), kFitFrames));
    const TiltFound found = searchTilt(heart, d, 10);
    std::printf("-6 degrees found as %.2f, rotation %.2f, D %.4f from %.4f\n",
                degreesFromRadians(found.tilt.tilt_rad), degreesFromRadians(found.tilt.rotate_rad),
                found.found.discrepancy, found.untilted);
    EXPECT_NEAR(degreesFromRadians(found.tilt.tilt_rad), -6, 1);
    EXPECT_NEAR(degreesFromRadians(found.tilt.rotate_rad), 0, 4);
    EXPECT_LT(found.found.discrepancy, found.untilted - 0.05);
    EXPECT_GT(found.tilt_confidence, 0.1);
  });
}

TEST(CompareTilt, TiltsThatAreNoneAreRefused) {
  for (const double bad : {-1.0, 20.5, std::nan(""), HUGE_VAL})
    EXPECT_THROW(checkTilt(bad), SceneError);
  for (const double good : {0.0, 10.0, 20.0}) checkTilt(good);
}

}  // namespace
}  // namespace echocine::fit
