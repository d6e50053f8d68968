// Views found from meshes: against the parametric heart's own, turned along with any heart, and by
// what they show.

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "motion/heart/heart_poses.h"
#include "motion/views/heart_marks.h"
#include "scene/view_names.h"
#include "support/real_hearts.h"
#include "support/view_poses.h"

namespace echocine {
namespace {

using namespace support;

using Dials = std::map<std::string, double>;
using Surfaces = std::vector<RoleSurface>;

const heart::ParametricHeart& defaultHeart() {
  static const heart::ParametricHeart made(heart::parametersFrom({}));
  return made;
}
Surfaces surfacesOf(const heart::ParametricHeart& model) {
  Surfaces surfaces;
  for (const heart::Part& part : model.at(0))
    if (const Role role = guessRole(part.kind.name);
        role != Role::none && role != Role::surroundings)
      surfaces.push_back({role, part.kind.name, part.points, part.faces});
  return surfaces;
}
const Surfaces& defaultSurfaces() {
  static const Surfaces surfaces = surfacesOf(defaultHeart());
  return surfaces;
}
Surfaces only(const Surfaces& all, const std::vector<Role>& roles) {
  Surfaces some;
  for (const RoleSurface& s : all)
    if (std::find(roles.begin(), roles.end(), s.role) != roles.end()) some.push_back(s);
  return some;
}

// The pose from the places that the model states, without looking at meshes except for the sac.
ProbePose ownPose(View view, const HeartFrame& own, const Surfaces& surfaces) {
  return standardPose(view, own, outsideOf(only(surfaces, {Role::pericardium})));
}
HeartFrame ownFrame(const heart::ParametricHeart& model) {
  const heart::Landmarks marks = model.landmarksAt(0);
  HeartFrame frame;
  frame.length_m = model.lvLength();
  frame.scale = model.parameters().body_scale;
  frame.apex = marks.apex;
  frame.mitral = marks.mitral;
  frame.aortic = marks.aortic;
  frame.aortic_flow = marks.aortic_flow;
  frame.has_left_atrium = true;
  return frame;
}

TEST(ViewPoseLaw, ParametricHeartsAreSeenFromTheirStatedPlaces) {
  for (const Dials& dials : {Dials{}, Dials{{"body-scale", 0.6}}, Dials{{"edv", 200}, {"ef", 0.3}},
                             Dials{{"sphericity", 0.75}}}) {
    const heart::ParametricHeart model(heart::parametersFrom(dials));
    const Surfaces surfaces = surfacesOf(model);
    const HeartFrame own = ownFrame(model);
    for (const ViewName& name : viewNames())
      expectNear(poseIn(name.view, surfaces), ownPose(name.view, own, surfaces), 10, 10, name.key);
  }
}

// What a lab may have of a heart.
TEST(ViewPoseLaw, FewRolesLeadToTheSameViews) {
  struct Few {
    const char* what;
    std::vector<Role> roles;
    double most_deg, most_mm;
  };
  const std::vector<Few> cases = {
      // The rings are estimated from the atria, which bend towards each other: 10.7 deg, 13.7 mm.
      {"four cavities", {Role::lv_cavity, Role::rv_cavity, Role::la, Role::ra}, 12, 15},
      {"ventricles and valves",
       {Role::lv_cavity, Role::rv_cavity, Role::lv_wall, Role::mitral_valve, Role::aortic_valve},
       15,
       15},
      {"ventricles alone", {Role::lv_cavity, Role::rv_cavity}, 20, 25},
      {"left heart and aorta",
       {Role::lv_cavity, Role::la, Role::aorta, Role::pericardium},
       15,
       20}};
  const HeartFrame own = ownFrame(defaultHeart());
  for (const Few& few : cases)
    for (const View view : {View::a4c, View::a2c, View::a3c, View::plax, View::psax_mid})
      expectNear(poseIn(view, only(defaultSurfaces(), few.roles)),
                 ownPose(view, own, defaultSurfaces()), few.most_deg, few.most_mm,
                 std::string(few.what) + ", " + keyOf(view));
}

// How far the nearest place of the surfaces in front of the probe's face is, within 10 mm of the
// beam.
double distanceToHeart(View view, const HeartMarks& marks) {
  const ProbePose pose = poseIn(view, marks);
  double nearest_m = 1;
  for (const Facet& facet : refined(marks.outside_m, 1e-3))
    for (const Vec3d p : facet) {
      const double deep_m = dot(p - pose.apex, pose.axis);
      if (length(p - pose.apex - deep_m * pose.axis) < 10e-3 && deep_m > 0)
        nearest_m = std::min(nearest_m, deep_m);
    }
  return nearest_m;
}

TEST(ViewPoseLaw, TheProbeStandsAtTheStatedDistanceFromTheHeart) {
  const HeartMarks all = marksIn(defaultSurfaces());
  for (const auto& [view, stated_m] : {std::pair{View::a4c, 16e-3},
                                       {View::a2c, 16e-3},
                                       {View::subcostal, 45e-3},
                                       {View::tee_4c, 5e-3}})
    EXPECT_NEAR(distanceToHeart(view, all), stated_m * all.frame.scale, 0.5e-3) << keyOf(view);
  // Half the long axis stands for an atrium that the meshes lack.
  const HeartMarks few = marksIn(only(
      defaultSurfaces(), {Role::lv_cavity, Role::rv_cavity, Role::lv_wall, Role::mitral_valve}));
  const HeartFrame& frame = few.frame;
  EXPECT_GT(dot(frame.origin - poseIn(View::tee_4c, few).apex, frame.apical),
            0.45 * frame.length_m);
}

// Only a valve or a vessel moves it from there.
TEST(ViewPoseLaw, AnUnknownAorticValveIsAtItsMeanPlace) {
  const HeartFrame frame =
      marksIn(only(defaultSurfaces(), {Role::lv_cavity, Role::rv_cavity, Role::mitral_valve}))
          .frame;
  const double l = frame.length_m;
  EXPECT_LT(length(frame.aortic - frame.at({-0.15 * l, 0.26 * l, 0.02 * l})), 1e-12);
}

// Parallel lines show what lies before them: neither what is beside them, nor slanting paths to it.
TEST(ViewPoseLaw, ALinearProbeIsAsDeepAsItsImageNeeds) {
  const ProbePose pose{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
  const auto plate = [](double x, double z) {
    return Facet{Vec3d{x - 1e-3, 0, z}, Vec3d{x + 1e-3, 1e-3, z}, Vec3d{x + 1e-3, -1e-3, z}};
  };
  const Facets surface{plate(0.015, 0.10), plate(0.06, 0.14)};
  const double none_m = fittingDepth(Facets{}, pose, -0.02, 0.02, 1);
  EXPECT_NEAR(fittingDepth(surface, pose, -0.02, 0.02, 1) - none_m, 0.10, 1e-12);
  EXPECT_NEAR(fittingDepth(surface, pose, -0.02, 0.07, 1) - none_m, 0.14, 1e-12);
}

// A turn about any axis, then a shift; or the mirror image of that.
struct Motion {
  Vec3d axis;
  double angle_rad;
  Vec3d shift_m;
  bool mirrored;

  Vec3d direction(Vec3d v) const {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    const Vec3d turned = c * v + s * cross(axis, v) + (1 - c) * dot(axis, v) * axis;
    return mirrored ? Vec3d{-turned.x, turned.y, turned.z} : turned;
  }
  Vec3d operator()(Vec3d p) const { return direction(p) + shift_m; }
  Surfaces operator()(Surfaces surfaces) const {
    for (RoleSurface& s : surfaces)
      for (Vec3d& p : s.points_m) p = (*this)(p);
    return surfaces;
  }
};

TEST(ViewPoseLaw, TheProbeTurnsAlongWithTheHeart) {
  const std::vector<std::vector<Role>> sets = {
      {Role::lv_cavity, Role::rv_cavity, Role::la, Role::ra, Role::aorta, Role::lv_wall,
       Role::mitral_valve, Role::aortic_valve, Role::tricuspid_valve},
      {Role::lv_cavity, Role::rv_cavity, Role::aorta},
      {Role::lv_cavity, Role::la, Role::ra, Role::aorta}};
  for (const std::vector<Role>& roles : sets)
    for (const bool mirrored : {false, true})
      for (const double angle_rad : {0.4, 2.0, 3.1}) {
        const Surfaces heart = only(defaultSurfaces(), roles);
        const Motion motion{
            normalised(Vec3d{0.3, -0.8, 0.5}), angle_rad, {0.2, -1.5, 0.7}, mirrored};
        const HeartMarks moved = marksIn(motion(heart)), still = marksIn(heart);
        for (const ViewName& name : viewNames()) {
          const ProbePose there = poseIn(name.view, moved), here = poseIn(name.view, still);
          EXPECT_LT(length(there.apex - motion(here.apex)), 1e-7) << name.key << mirrored;
          EXPECT_LT(length(there.axis - motion.direction(here.axis)), 1e-6) << name.key;
          EXPECT_LT(length(there.lateral - motion.direction(here.lateral)), 1e-6) << name.key;
          EXPECT_NEAR(there.depth_m, here.depth_m, 1e-7) << name.key;
        }
      }
}

TEST(ViewPoseLaw, AMirroredHeartIsTold) {
  const Motion mirror{{0, 0, 1}, 0, {}, true};
  EXPECT_TRUE(marksIn(defaultSurfaces()).told.empty());
  const HeartMarks marks = marksIn(mirror(defaultSurfaces()));
  ASSERT_EQ(marks.told.size(), 1u);
  EXPECT_NE(marks.told[0].find("mirrored heart"), std::string::npos) << marks.told[0];
}

// A heart of another size is another body's: everything in proportion.
TEST(ViewPoseLaw, PosesGrowWithTheHeart) {
  Surfaces large = defaultSurfaces();
  for (RoleSurface& s : large)
    for (Vec3d& p : s.points_m) p = 1.7 * p;
  for (const ViewName& name : viewNames()) {
    const ProbePose big = poseIn(name.view, large), small = poseIn(name.view, defaultSurfaces());
    EXPECT_LT(length(big.apex - 1.7 * small.apex), 1e-7) << name.key;
    EXPECT_LT(length(big.axis - small.axis), 1e-6) << name.key;
    EXPECT_NEAR(big.depth_m, 1.7 * small.depth_m, 1e-7) << name.key;
  }
}

// Structures that a view must show and must not, by what its sector cuts of them.
struct Seen {
  View view;
  std::vector<Role> shown, hidden;
};
const std::vector<Seen> kSeen = {
    {View::a4c,
     {Role::lv_cavity, Role::rv_cavity, Role::la, Role::ra, Role::mitral_valve,
      Role::tricuspid_valve},
     {Role::aortic_valve}},
    {View::a2c,
     {Role::lv_cavity, Role::la, Role::mitral_valve},
     {Role::rv_cavity, Role::ra, Role::tricuspid_valve, Role::aortic_valve}},
    {View::a3c,
     {Role::lv_cavity, Role::la, Role::aorta, Role::rv_cavity, Role::aortic_valve,
      Role::mitral_valve},
     {Role::tricuspid_valve}},
    {View::plax,
     {Role::lv_cavity, Role::la, Role::aorta, Role::rv_cavity, Role::mitral_valve},
     {Role::tricuspid_valve}},
    {View::psax_base, {Role::rv_cavity, Role::la, Role::ra, Role::aorta}, {}},
    {View::psax_mid, {Role::lv_cavity, Role::rv_cavity}, {Role::la, Role::ra, Role::aorta}},
    {View::psax_apex, {Role::lv_cavity}, {Role::la, Role::ra, Role::aorta}},
    {View::subcostal, {Role::lv_cavity, Role::rv_cavity, Role::la, Role::ra}, {}},
    {View::tee_4c, {Role::lv_cavity, Role::rv_cavity, Role::la, Role::mitral_valve}, {}}};

void expectSeen(const RealHeart& heart) {
  const HeartMarks marks = marksIn(heart.surfaces);
  for (const Seen& seen : kSeen) {
    if (seen.view == View::psax_base && !heart.has_aorta) continue;
    const ProbePose pose = poseIn(seen.view, marks);
    // A valve is a line; a sliver of an appendage is not a chamber.
    const auto shows = [&](Role role, double least_m = 5e-3) {
      return cutLength_m(heart, role, pose) > least_m;
    };
    for (const Role role : seen.shown)
      EXPECT_TRUE(!heart.has(role) || shows(role))
          << heart.name << ", " << keyOf(seen.view) << ": no " << nameOf(role);
    // The outline of a sliver is twice as long as the sliver.
    for (const Role role : seen.hidden)
      EXPECT_FALSE(heart.has(role) && shows(role, 40e-3))
          << heart.name << ", " << keyOf(seen.view) << ": " << nameOf(role) << ", "
          << 1e3 * cutLength_m(heart, role, pose) << " mm";
  }
}

TEST(ViewPoseLaw, EveryViewShowsWhatItMust) {
  RealHeart shipped{"parametric", {}, {}, {}, {}, {}, {}, true};
  for (const heart::Part& part : defaultHeart().at(0)) {
    const Role role = guessRole(part.kind.name);
    if (role == Role::none || role == Role::surroundings) continue;
    shipped.surfaces.push_back({role, part.kind.name, part.points, part.faces});
    shipped.triangles.push_back(part.faces);
  }
  expectSeen(shipped);
  if (!realHeartsThere()) GTEST_SKIP() << "no real hearts beside the project";
  for (const RealHeart& heart : {patientHeart(), wholeHeart(), fourChamberHeart()})
    expectSeen(heart);
}

}  // namespace
}  // namespace echocine
