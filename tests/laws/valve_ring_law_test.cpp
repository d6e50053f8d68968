// Fibrous rings of the mitral and tricuspid valves: cords along the hinges of leaflets, in the
// picture alone.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "core/error.h"
#include "frame/simulator.h"
#include "motion/heart/heart.h"
#include "motion/heart/heart_scene.h"
#include "motion/surfaces/valve_rings.h"
#include "scene/role.h"
#include "speckle/sheet_points.h"
#include "support/all_cases.h"
#include "support/bind_to_surface.h"
#include "support/picture_only.h"
#include "support/random_dials.h"

namespace echocine::valve_ring_law {
namespace {

constexpr double kDiameter_m = 4e-3;

Scene heartWith(const std::map<std::string, double>& dials, double annulus_m = kDiameter_m) {
  Scene scene = heart::heartScene(heart::parametersFrom(dials), heart::View::a4c, 8);
  scene.leaflets.annulus_m = annulus_m;
  return scene;
}

struct Ring {
  double length_m = 0, radius_m = 0;  // of the hinges
};

Ring ringOf(const Scene& scene, const ValveRings& rings, const SurfaceFrame& frame, Role valve) {
  std::vector<ValveRings::Section> sections;
  rings.at(frame, sections);
  Ring ring;
  Vec3d sum_m{};
  std::vector<Vec3d> hinge_m;
  for (const ValveRings::Stretch& s : rings.stretches()) {
    if (roleOf(scene.structures[index(s.leaflet)]) != valve) continue;
    // The hinge touches the cord from inside.
    const Vec3d from = toDouble(rings.place(sections[s.from], -1, 0)),
                to = toDouble(rings.place(sections[s.to], -1, 0));
    ring.length_m += length(to - from);
    for (const Vec3d p : {from, to}) {
      hinge_m.push_back(p);
      sum_m = sum_m + p;
    }
  }
  const double each = 1 / static_cast<double>(hinge_m.size());
  for (const Vec3d p : hinge_m) ring.radius_m += each * length(p - each * sum_m);
  return ring;
}

// Laws: a section is a disc across the ring; the hinges are circles of the model's radius, open
// at the aorta, at every instant; no section moves farther than its valve and its leaflet's hinge.
void expectSound(const std::map<std::string, double>& dials) {
  const Scene scene = heartWith(dials);
  const MeshMotion motion(scene);
  const ValveRings rings(scene, motion);
  const heart::ParametricHeart model(heart::parametersFrom(dials));
  std::map<SurfaceId, int> stretches;
  for (const ValveRings::Stretch& s : rings.stretches()) ++stretches[s.leaflet];
  EXPECT_EQ(stretches.size(), 4u);
  SurfaceFrame frame;
  std::vector<ValveRings::Section> sections, before;
  for (int i = 0; i < 32; ++i) {
    const double phase = i / 32.0;
    motion.frameAt(phase, frame, false);
    rings.at(frame, sections);
    ASSERT_FALSE(sections.empty());
    for (const ValveRings::Section& s : sections) {
      ASSERT_NEAR(length(s.outward), 1, 1e-4);
      ASSERT_NEAR(dot(s.outward, s.axis), 0, 1e-4);
    }
    const heart::Landmarks marks = model.landmarksAt(phase);
    for (const auto& [valve, radius_m] :
         {std::pair(Role::mitral_valve, marks.mitral_radius_m),
          std::pair(Role::tricuspid_valve, marks.tricuspid_radius_m)}) {
      const Ring ring = ringOf(scene, rings, frame, valve);
      const double around = ring.length_m / (2 * std::numbers::pi * radius_m);
      ASSERT_NEAR(ring.radius_m / radius_m, 1, 0.2) << phase;
      ASSERT_GT(around, 0.5) << phase;
      ASSERT_LT(around, 1.3) << phase;
    }
    for (std::size_t s = 0; s < before.size(); ++s)
      ASSERT_LT(length(sections[s].middle_m - before[s].middle_m), 8e-3f) << phase;
    before = sections;
  }
}

// Scatterers of rings grow with the cube of the frequency.
TEST(ValveRingLaw, MoreScatterersThanMemoryIsMeantForAreRefused) {
  Scene scene = heartWith({}, 10e-3);
  scene.probe.frequency_hz = 60e6;
  scene.signal.pulse_cycles = 1;
  try {
    const Simulator simulator(scene);
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("leaflets.annulus_mm = 10 needs over"))
        << error.what();
  }
}

TEST(ValveRingLaw, FollowTheHinges) {
  expectSound({});
  expectSound({{"edv", 70}, {"body-scale", 0.8}});
  expectSound({{"edv", 220}, {"ef", 0.2}, {"mitral-opening", 0.2}});
}

// Dials of any heart. Those without a shape are rejected elsewhere.
TEST(ValveRingLaw, FollowTheHingesOfRandomHearts) {
  support::checkRandomHearts(support::allCases() ? 1000 : 6, expectSound);
}

TEST(ValveRingLaw, ScatterersStayInTheCord) {
  Scene scene = heartWith({});
  scene.speckle.on = true;
  const MeshMotion motion(scene);
  const auto rings = std::make_shared<const ValveRings>(scene, motion);
  const SheetPoints without(scene, motion, 0), with(scene, motion, 0, {.rings = rings});
  ASSERT_GT(with.count(), without.count() + 1000);
  SurfaceFrame frame;
  motion.frameAt(0.4, frame, false);
  std::vector<Vec3f> places_m;
  std::vector<ValveRings::Section> sections;
  with.at(frame, places_m);
  rings->at(frame, sections);
  ASSERT_EQ(places_m.size(), with.count());
  for (std::size_t p = without.count(); p < places_m.size(); ++p) {
    double nearest_m = 1;
    for (const ValveRings::Stretch& s : rings->stretches())
      nearest_m = std::min(nearest_m, distanceToSegment(places_m[p], sections[s.from].middle_m,
                                                        sections[s.to].middle_m));
    ASSERT_LT(nearest_m, 0.51 * kDiameter_m);
  }
}

TEST(ValveRingLaw, ChangeThePictureAndNoTruth) {
  support::expectPictureOnly(heartWith({}, 0), heartWith({}));
}

TEST(ValveRingLaw, AreOfLooksButThePaperAndNeedALeaflet) {
  EXPECT_FALSE(planEffects(heartWith({}, 0)).annulus);
  Scene scene = heartWith({});
  EXPECT_TRUE(planEffects(scene).annulus);
  scene.accuracy.rays_per_beam = 8;
  EXPECT_FALSE(planEffects(scene).annulus);
  scene = heartWith({});
  std::erase_if(scene.structures, [](const Structure& s) {
    return roleOf(s) == Role::mitral_valve || roleOf(s) == Role::tricuspid_valve;
  });
  EXPECT_FALSE(planEffects(scene).annulus);
  support::expectOfLooksButPaper(&LeafletSettings::annulus_m);
}

}  // namespace
}  // namespace echocine::valve_ring_law
