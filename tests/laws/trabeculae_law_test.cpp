// The relief of the ventricles' inner surfaces: a normal field about the mesh, which changes the
// picture and nothing else.

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "frame/simulator.h"
#include "geometry/plane_slice.h"
#include "motion/heart/heart_scene.h"
#include "motion/surfaces/trabeculae.h"
#include "scene/role.h"
#include "speckle/field_material.h"
#include "support/all_cases.h"
#include "support/picture_only.h"

namespace echocine {
namespace {

using support::allCases, support::casesOf;

constexpr int kKeyframes = 8;

Scene heartWith(double height_mm, heart::View view = heart::View::a4c) {
  static std::map<heart::View, Scene> hearts;
  if (hearts.count(view) == 0)
    hearts.emplace(view, heart::heartScene(heart::parametersFrom({}), view, kKeyframes));
  Scene scene = hearts.at(view);
  scene.trabeculae.deviation_m = 1e-3 * height_mm;
  return scene;
}

double volumeOf(const MeshMotion& motion, const SurfaceFrame& frame, SurfaceId id) {
  return enclosedVolume(motion.surfaces()[index(id)], frame.positions_m[index(id)]);
}

// A surface with others at its side, all of them smooth, as the frames of a motion are.
struct Rough {
  explicit Rough(const Scene& scene, bool everywhere = true)
      : motion(scene), trabeculae(scene, motion, everywhere) {}
  SurfaceFrame at(double phase) const {
    SurfaceFrame frame;
    Trabeculae::Smooth smooth;
    motion.frameAt(phase, frame, false);
    trabeculae.raise(frame, smooth);
    return frame;
  }
  MeshMotion motion;
  Trabeculae trabeculae;
};

TEST(Trabeculae, AreThoseOfBothVentriclesAndOfNothingElse) {
  const Scene scene = heartWith(1);
  const Rough rough(scene);
  std::vector<Role> roles;
  for (const Relief& relief : rough.trabeculae.reliefs())
    roles.push_back(roleOf(scene.structures[index(relief.surface)]));
  EXPECT_EQ(roles, (std::vector<Role>{Role::lv_cavity, Role::rv_cavity}));
  EXPECT_TRUE(Rough(heartWith(0)).trabeculae.reliefs().empty());
}

// Law: far from other blood the height is a normal field cut at two deviations: mean 0, and its own
// deviation sqrt(0.9205) of the one asked for.
TEST(Trabeculae, AreANormalFieldAboutTheMesh) {
  double sum = 0, squares = 0, count = 0;
  for (int seed = 1; seed <= 3; ++seed) {
    Scene scene = heartWith(0.5);
    scene.trabeculae.seed = seed;
    const Rough rough(scene);
    for (const Relief& relief : rough.trabeculae.reliefs()) {
      SurfaceFrame frame;
      rough.motion.frameAt(0, frame, false);
      const std::vector<Vec3f>& at_m = frame.positions_m[index(relief.surface)];
      const auto base =
          structureOf(scene, roleOf(scene.structures[index(relief.surface)]) == Role::lv_cavity
                                 ? Role::rv_cavity
                                 : Role::ra);
      for (std::size_t v = 0; v < at_m.size(); v += 13) {
        double nearest_m = 1;
        for (const SurfaceId other :
             {*base, *structureOf(scene, Role::la), *structureOf(scene, Role::aorta),
              *structureOf(scene, Role::ra), *structureOf(scene, Role::pulmonary_artery)})
          for (const Vec3f p : frame.positions_m[index(other)])
            nearest_m = std::min(nearest_m, length(toDouble(p - at_m[v])));
        const double h = static_cast<double>(relief.height_m[v]);
        EXPECT_LE(std::abs(h), 2 * 0.5e-3 * (1 + 1e-6));
        if (nearest_m < 4e-3) {
          EXPECT_LT(std::abs(h), 0.05e-3);
        }
        if (nearest_m < 16e-3) continue;
        sum += h;
        squares += h * h;
        ++count;
      }
    }
  }
  ASSERT_GT(count, 300);
  const double mean = sum / count;
  EXPECT_NEAR(mean, 0, 0.1 * 0.5e-3);
  EXPECT_NEAR(std::sqrt(squares / count - mean * mean), std::sqrt(0.9205) * 0.5e-3, 0.1 * 0.5e-3);
}

// Volumes about the mesh's own, over seeds; the mesh's own are those that are told.
TEST(Trabeculae, LeaveTheVolumesOfTheSmoothSurface) {
  double ratio = 0;
  constexpr int kSeeds = 4;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Scene scene = heartWith(1);
    scene.trabeculae.seed = seed;
    const Rough rough(scene);
    const SurfaceId cavity = *structureOf(scene, Role::lv_cavity);
    SurfaceFrame frame;
    rough.motion.frameAt(0, frame, false);
    ratio += volumeOf(rough.motion, rough.at(0), cavity) / volumeOf(rough.motion, frame, cavity) /
             kSeeds;
  }
  EXPECT_NEAR(ratio, 1, 0.01);
}

TEST(Trabeculae, GiveTheSmoothFrameBack) {
  const Rough rough(heartWith(2));
  SurfaceFrame frame, before;
  Trabeculae::Smooth smooth;
  for (const double phase : {0.0, 0.3, 0.77}) {
    rough.motion.frameAt(phase, frame, false);
    rough.motion.frameAt(phase, before, false);
    rough.trabeculae.raise(frame, smooth);
    EXPECT_NE(frame.positions_m, before.positions_m);
    rough.trabeculae.lower(frame, smooth);
    EXPECT_EQ(frame.positions_m, before.positions_m);
  }
}

// However high: no face looks the other way, between the phases looked at neither.
TEST(Trabeculae, TurnNoFaceOver) {
  const Rough rough(heartWith(4));
  SurfaceFrame frame;
  for (int i = 0; i < 32; i += allCases() ? 1 : 3) {
    const SurfaceFrame raised = rough.at(i / 32.0);
    rough.motion.frameAt(i / 32.0, frame, false);
    int turned = 0;
    for (const Relief& relief : rough.trabeculae.reliefs()) {
      const std::size_t s = index(relief.surface);
      for (const Triangle& t : rough.motion.surfaces()[s].triangles) {
        const auto normal = [&](const SurfaceFrame& of) {
          const std::vector<Vec3f>& at_m = of.positions_m[s];
          return toDouble(cross(at_m[t[1]] - at_m[t[0]], at_m[t[2]] - at_m[t[0]]));
        };
        turned += dot(normal(frame), normal(raised)) <= 0;
      }
    }
    EXPECT_LE(turned, i % 2 == 0 ? 0 : 4) << i;
  }
}

// What is shown of a slice is the same whether all vertices move or those about the plane.
TEST(Trabeculae, AboutThePlaneAreThoseOfTheWholeSurface) {
  for (const heart::View view :
       casesOf<heart::View>({heart::View::psax_mid, heart::View::a4c}, 1)) {
    const Scene scene = heartWith(1.5, view);
    const Rough all(scene, true), some(scene, false);
    PlaneSlice one(all.motion.surfaces(), scene.probe, {}),
        two(some.motion.surfaces(), scene.probe, {});
    for (const double phase : {0.0, 0.35, 0.8}) {
      const SurfaceFrame whole = all.at(phase), part = some.at(phase);
      one.update(whole);
      two.update(part);
      ASSERT_EQ(one.edges().size(), two.edges().size());
      EXPECT_GT(one.edges().size(), 100u);
      EXPECT_NE(whole.positions_m, part.positions_m);
      for (const Relief& relief : some.trabeculae.reliefs())
        for (const std::uint32_t v : relief.moved)
          EXPECT_EQ(whole.positions_m[index(relief.surface)][v],
                    part.positions_m[index(relief.surface)][v]);
    }
  }
}

// They belong to the heart: a probe elsewhere meets the same ridges.
TEST(Trabeculae, AreTheSameFromEverywhere) {
  const Rough one(heartWith(1, heart::View::a4c)), two(heartWith(1, heart::View::plax));
  for (std::size_t r = 0; r < 2; ++r) {
    const std::vector<float>&a = one.trabeculae.reliefs()[r].height_m,
          &b = two.trabeculae.reliefs()[r].height_m;
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t v = 0; v < a.size(); ++v) EXPECT_NEAR(a[v], b[v], 1e-6) << v;
  }
}

// Law: truth is that of the smooth surface; the picture is not.
TEST(Trabeculae, ChangeThePictureAndNoTruth) {
  support::expectPictureOnly(heartWith(0), heartWith(1));
}

// Law: what stands in a ridge is wall and moves with it; what stands beside it is blood.
TEST(Trabeculae, ScatterersInARidgeAreTheWalls) {
  const Scene scene = heartWith(1.5);
  const Rough rough(scene);
  const FieldMaterial plain(scene, rough.motion),
      material(scene, rough.motion, nullptr, &rough.trabeculae);
  SurfaceFrame frame;
  rough.motion.frameAt(plain.field().referencePhase(), frame, false);
  const SurfaceId cavity = *structureOf(scene, Role::lv_cavity);
  const std::size_t s = index(cavity);
  const GroupId blood = plain.field().groupOf(cavity);
  const Relief& relief = rough.trabeculae.reliefs().front();
  const SurfaceFrame raised = rough.at(plain.field().referencePhase());
  int in_ridges = 0, walls = 0, beside = 0, still_blood = 0;
  for (std::size_t v = 0; v < relief.height_m.size(); ++v) {
    if (!(relief.height_m[v] > 1e-3f)) continue;
    const Vec3f in = raised.positions_m[s][v] - frame.positions_m[s][v];
    const Vec3f places_m[] = {frame.positions_m[s][v] + 0.5f * in,
                              frame.positions_m[s][v] + 1.5f * in};
    std::uint16_t before[2], groups[2];
    plain.groupsAt(places_m, before);
    material.groupsAt(places_m, groups);
    if (before[0] == index(blood)) {
      ++in_ridges;
      walls += groups[0] != before[0] && !material.blood(groups[0]);
    }
    if (before[1] == index(blood)) {
      ++beside;
      still_blood += groups[1] == before[1];
    }
  }
  ASSERT_GT(in_ridges, 100);
  EXPECT_GT(walls, 0.9 * in_ridges);
  EXPECT_GT(still_blood, 0.9 * beside);
}

// A wall whose inner side is a surface of its own goes along with the cavity's.
TEST(Trabeculae, TakeASharedSurfaceAlong) {
  Scene scene = heartWith(1);
  Structure inner = scene.structures[index(*structureOf(scene, Role::lv_cavity))];
  inner.name = "inner_side";
  inner.role = Role::lv_wall;
  scene.structures.push_back(inner);
  const Rough rough(scene);
  const SurfaceFrame frame = rough.at(0.4);
  EXPECT_EQ(frame.positions_m.back(),
            frame.positions_m[index(*structureOf(scene, Role::lv_cavity))]);
}

}  // namespace
}  // namespace echocine
