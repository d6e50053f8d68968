// Speckle in a whole scene: a heart of spheres that beats, by the field that moves its material.

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "frame/simulator.h"
#include "motion/cycle/cardiac_clock.h"
#include "plan/loop_plan.h"
#include "scene/scene_reader.h"
#include "speckle/field_material.h"
#include "speckle/sheet_points.h"
#include "speckle/speckle.h"
#include "support/loop_scene.h"

namespace echocine {
namespace {

class SpeckleScene : public testing::Test {
 protected:
  Scene beatingScene() const {
    support::SceneText text = support::ballScene(10);
    text.output["exr"] = "false";
    text.probe["samples"] = "256";
    text.extra = "[speckle]\non = true\n";
    return readScene(support::writeBall(folder_, text));
  }

 private:
  support::TempFolder folder_;
};

TEST_F(SpeckleScene, AnyFrameAloneHasTheBytesOfTheLoopForAnyThreads) {
  const Simulator simulator(beatingScene());
  ASSERT_TRUE(simulator.plan().effects.speckle);
  const Intensities first = simulator.frame(0.1).intensities;
  const Intensities other = simulator.frame(0.3).intensities;
  EXPECT_NE(first, other);
  EXPECT_EQ(simulator.frame(0.1).intensities, first);
  const Simulator again(beatingScene());
  withThreads(2, [&] { EXPECT_EQ(again.frame(0.3).intensities, other); });
}

TEST_F(SpeckleScene, TheMeanOverSeedsIsTheFrameWithout) {
  constexpr int kSeeds = 8;
  constexpr double kTime_s = 0.3;
  Scene scene = beatingScene();
  scene.speckle.on = false;
  const Simulator without(scene);
  const Intensities expected = without.frame(kTime_s).intensities;
  const FieldMaterial material(scene, without.motion());
  FieldFrame field;
  material.field().at(without.cardiacClock().atTime(kTime_s).phase, field);
  scene.speckle.smoothing_m = 0;
  std::vector<double> sum(expected.size());
  for (scene.speckle.seed = 1; scene.speckle.seed <= kSeeds; ++scene.speckle.seed) {
    const Speckle speckle(scene.probe, PointSpread(scene), scene.speckle, material);
    Intensities speckled = expected;
    speckle.apply(FieldMaterialFrame(field), kTime_s, speckled);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += static_cast<double>(speckled[i]);
  }
  double ratios = 0, squares = 0, n = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (expected[i] == 0) continue;
    const double ratio = sum[i] / kSeeds / static_cast<double>(expected[i]);
    n += 1;
    ratios += ratio;
    squares += (ratio - 1) * (ratio - 1);
  }
  EXPECT_NEAR(ratios / n, 1, 0.02);
  EXPECT_NEAR(std::sqrt(squares / n), 1 / std::sqrt(kSeeds), 0.1 / std::sqrt(kSeeds));
}

TEST_F(SpeckleScene, PointsOfAMembraneStandOnItsTriangles) {
  const Scene scene = beatingScene();
  const MeshMotion motion(scene);
  const SheetPoints sheets(scene, motion, 0);
  ASSERT_GT(sheets.count(), 100u);
  SurfaceFrame surfaces;
  motion.frameAt(0.3, surfaces);
  std::size_t leaflet = 0;
  while (!motion.surfaces()[leaflet].membrane) ++leaflet;
  std::vector<Vec3f>& corners = surfaces.positions_m[leaflet];
  for (Vec3f& p : corners) p = p + Vec3f{0, 0, 0.001f};  // wherever the sheet goes
  Box box;
  for (const Vec3f p : corners) box.add(toDouble(p));
  std::vector<Vec3f> places_m;
  sheets.at(surfaces, places_m);
  ASSERT_EQ(places_m.size(), sheets.count());
  constexpr double kRounding_m = 1e-7;
  Vec3d sum;
  for (const Vec3f p : places_m) {
    ASSERT_NEAR(static_cast<double>(p.z), 0.5 * (box.lo.z + box.hi.z), kRounding_m);  // it is even
    ASSERT_TRUE(box.lo.x - kRounding_m <= static_cast<double>(p.x) &&
                static_cast<double>(p.x) <= box.hi.x + kRounding_m);
    sum = sum + toDouble(p);
  }
  const double middle = 0.5 * (box.lo.x + box.hi.x), width = box.hi.x - box.lo.x;
  EXPECT_NEAR(sum.x / static_cast<double>(sheets.count()), middle, 0.05 * width);  // even by area
  sheets.at({}, places_m);
  EXPECT_TRUE(places_m.empty());
}

// The cubes that carry scatterers are the field's own cells: what a tracker should find.
TEST_F(SpeckleScene, ScatterersMoveByTheVeryFieldOfTheTruth) {
  const Scene scene = beatingScene();
  const MeshMotion motion(scene);
  const FieldMaterial material(scene, motion);
  FieldFrame frame;
  material.field().at(0.3, frame);
  const FieldMaterialFrame tissue(frame);
  const CubeLattice lattice = material.lattice();
  int moved = 0;
  for (std::uint16_t group = 0; group < frame.groups.size(); ++group) {
    const float edge_m = 0.5f * lattice.block_m;
    const float middle_y = std::round(-lattice.origin_m.y / edge_m);
    for (int cube = 0; cube < 3600; ++cube) {
      const Vec3f low = lattice.origin_m + edge_m * Vec3f{static_cast<float>(cube % 60), middle_y,
                                                          static_cast<float>(cube / 60)};
      const LatticeGrid& grid = frame.groups[group].grid;
      const Vec3f from = low - grid.origin_m, to = from + edge_m * Vec3f{1, 1, 1};
      const auto within = [&](float a, float b, int nodes) {
        const float whole = 1e-3f * grid.spacing_m;  // a cell, but for rounding
        return grid.empty() ||
               (a >= -whole && b <= grid.spacing_m * static_cast<float>(nodes - 1) + whole);
      };
      if (!within(from.x, to.x, grid.nx) || !within(from.y, to.y, grid.ny) ||
          !within(from.z, to.z, grid.nz))
        continue;  // no tissue of the group lies there
      const CubeCorners corners = tissue.corners(group, low, edge_m);
      Vec3f middle{};
      for (const Vec3f c : corners) middle = middle + 0.125f * c;
      const Vec3f by_field = frame.groups[group].place(low + 0.5f * edge_m * Vec3f{1, 1, 1});
      ASSERT_LT(length(middle - by_field), 1e-6f) << group << " " << cube;
      moved += length(by_field - (low + 0.5f * edge_m * Vec3f{1, 1, 1})) > 1e-3f;
    }
  }
  EXPECT_GT(moved, 100);
}

}  // namespace
}  // namespace echocine
