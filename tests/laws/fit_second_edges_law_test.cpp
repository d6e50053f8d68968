// Boundaries behind other edges: closed forms for parallel walls and sheets, and a heart's
// papillary muscles and leaflets.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/parallel.h"
#include "fit/second_edges.h"
#include "motion/heart/heart_scene.h"
#include "motion/surfaces/mesh_motion.h"

namespace echocine::fit {
namespace {

constexpr int kPieces = 60;
constexpr float kStep_m = kBoundaryPiece_m;

// A straight row of pieces at a distance before a place, with normals turned against it.
std::vector<BoundaryPoint> row(float z_m, float normal_rad, float first_m = 0) {
  std::vector<BoundaryPoint> out;
  for (int i = 0; i < kPieces; ++i) {
    BoundaryPoint p;
    p.x_m = first_m + (static_cast<float>(i) - kPieces / 2) * kStep_m;
    p.z_m = z_m;
    p.nx = std::sin(normal_rad), p.nz = std::cos(normal_rad);
    p.length_m = kStep_m;
    p.of_blood = true;
    out.push_back(p);
  }
  return out;
}

// alone in the middle of a wall with another row of edges at `before_m`.
float aloneBehind(const std::vector<BoundaryPoint>& other, bool sheet) {
  ModelFrame frame;
  frame.boundary = row(0.08f, 0);
  std::vector<SheetPoint> sheets;
  for (const BoundaryPoint& p : other)
    if (sheet)
      sheets.push_back({p.x_m, p.z_m, p.nx, p.nz});
    else
      frame.boundary.push_back(p);
  findSecondEdges(sheets, frame);
  return frame.boundary[kPieces / 2].alone;
}

double shareOf(double before_mm) {
  return std::clamp((before_mm - 2) / 1.5, 0.0, 1.0) * std::clamp((9 - before_mm) / 2, 0.0, 1.0);
}

// Leaflets are thick: they also count where they lie on the wall, and from farther away.
double sheetShareOf(double before_mm) {
  return std::clamp((before_mm + 1.5) / 1.5, 0.0, 1.0) *
         std::clamp((10.5 - before_mm) / 2, 0.0, 1.0);
}

TEST(FitSecondEdges, AParallelEdgeCountsByItsDistanceAlone) {
  for (double mm = -12; mm < 14; mm += 0.31)
    for (const float first : {0.0f, 0.3f * kStep_m, 0.77f * kStep_m})  // the hats sum to 1
      for (const bool sheet : {false, true})
        EXPECT_NEAR(aloneBehind(row(0.08f - 1e-3f * static_cast<float>(mm), 0, first), sheet),
                    1 - (sheet ? sheetShareOf(mm) : shareOf(mm)), 2e-4)
            << mm << " mm, " << first;
}

TEST(FitSecondEdges, OppositeEdgesDoNotCountButSheetsDo) {
  constexpr auto kPi = std::numbers::pi_v<float>;
  const float z = 0.075f;
  EXPECT_EQ(aloneBehind(row(z, kPi), false), 1);
  EXPECT_NEAR(aloneBehind(row(z, kPi), true), 0, 2e-4);
  EXPECT_NEAR(aloneBehind(row(z, kPi / 2), false), 1, 1e-5);
  EXPECT_NEAR(aloneBehind(row(z, kPi / 3), false), 0.5, 2e-4);
  EXPECT_NEAR(aloneBehind(row(z, 2 * kPi / 3), true), 0.5, 2e-4);
}

// Neither the sense nor the direction of a sheet's end counts.
TEST(FitSecondEdges, TheEndOfASheetIsADisc) {
  for (double before_mm = -4; before_mm < 13; before_mm += 0.7)
    for (double across_mm = -6; across_mm < 6; across_mm += 0.4) {
      ModelFrame frame;
      frame.boundary = row(0.08f, 0);
      const BoundaryPoint& wall = frame.boundary[kPieces / 2];
      const SheetPoint end{wall.x_m + 1e-3f * static_cast<float>(across_mm),
                           wall.z_m - 1e-3f * static_cast<float>(before_mm), 1, 0, true};
      findSecondEdges(std::span(&end, 1), frame);
      const double beside = std::clamp((4.5 - std::abs(across_mm)) / 1.5, 0.0, 1.0);
      EXPECT_NEAR(wall.alone, 1 - sheetShareOf(before_mm) * beside, 2e-4)
          << before_mm << " mm before, " << across_mm << " mm across";
    }
}

// The inside of a circle faces itself from 2 r away, with the opposite sense.
TEST(FitSecondEdges, ACircleIsAloneAtAnyRadius) {
  for (const double r_mm : {2.0, 4.0, 8.0, 25.0}) {
    ModelFrame frame;
    const int n = static_cast<int>(std::ceil(2 * std::numbers::pi * r_mm / 1.25));
    for (int i = 0; i < n; ++i) {
      const double turn = 2 * std::numbers::pi * i / n;
      BoundaryPoint p;
      p.nx = static_cast<float>(std::cos(turn)), p.nz = static_cast<float>(std::sin(turn));
      p.x_m = 1e-3f * static_cast<float>(r_mm) * p.nx;
      p.z_m = 0.08f + 1e-3f * static_cast<float>(r_mm) * p.nz;
      p.of_blood = true;
      frame.boundary.push_back(p);
    }
    findSecondEdges({}, frame);
    for (const BoundaryPoint& p : frame.boundary) EXPECT_EQ(p.alone, 1) << r_mm;
  }
}

// In a4c the anterolateral papillary muscle stands before the lateral wall; the septum and both
// atria are free, except beside the leaflets' hinges.
TEST(FitSecondEdges, PapillaryMusclesAndLeafletsHideTheWallBehindThem) {
  withThreads(2, [] {
    const Scene scene = heart::heartScene({}, heart::View::a4c, 20, Look::scanner);
    const ModelLoop model = modelLoop(scene, MeshMotion(scene), 20);
    const auto meanAlone = [&](const std::string& structure, bool lateral) {
      const auto s = std::find(model.structures.begin(), model.structures.end(), structure) -
                     model.structures.begin();
      double sum = 0, count = 0, middle = 0, all = 0;
      for (const ModelFrame& frame : model.frames)
        for (const BoundaryPoint& p : frame.boundary)
          if (p.surface == s) middle += static_cast<double>(p.x_m), ++all;
      for (const ModelFrame& frame : model.frames)
        for (const BoundaryPoint& p : frame.boundary)
          if (p.surface == s && p.of_blood &&
              (static_cast<double>(p.x_m) > middle / all) == lateral)
            sum += static_cast<double>(p.alone), ++count;
      return count > 0 ? sum / count : -1.0;
    };
    EXPECT_LT(meanAlone("lv_cavity", true), 0.95);
    EXPECT_GT(meanAlone("lv_cavity", false), 0.93);  // 4 mm of 80 mm lie beside the hinge
    EXPECT_GT(meanAlone("la", true), 0.99);
    EXPECT_GT(meanAlone("ra", false), 0.95);
  });
}

// The same cells and boundaries, of other weight far from the left ventricle.
TEST(FitFocus, OtherChambersCountLess) {
  withThreads(2, [] {
    const Scene scene = heart::heartScene({}, heart::View::a4c, 20, Look::scanner);
    const MeshMotion motion(scene);
    SurfaceFrame surfaces;
    motion.frameAt(0, surfaces, false);
    const ModelFrame all = ModelPlane(scene, motion.surfaces()).cut({surfaces}).frames.front(),
                     left = ModelPlane(scene, motion.surfaces(), {}, Focus::left_ventricle)
                                .cut({surfaces})
                                .frames.front();
    ASSERT_EQ(all.boundary.size(), left.boundary.size());
    int less = 0, full = 0;
    for (std::size_t i = 0; i < all.boundary.size(); ++i) {
      const BoundaryPoint &a = all.boundary[i], &b = left.boundary[i];
      const std::string& name = scene.structures[a.surface].name;
      const bool of_left = name == "lv_cavity" || name.starts_with("papillary");
      EXPECT_EQ(b.weight, of_left ? 1 : static_cast<float>(kOtherChambers)) << name;
      EXPECT_EQ(b.inside_m, static_cast<float>(kInside_m));
      EXPECT_EQ(a.weight, 1);
      EXPECT_EQ(a.inside_m, 0);
      EXPECT_EQ(a.alone, b.alone);
    }
    for (std::size_t c = 0; c < all.cells.size(); ++c) {
      const float part = all.cells[c].area > 0 ? left.cells[c].area / all.cells[c].area : 1;
      EXPECT_GE(part, static_cast<float>(kOtherChambers) - 1e-6f);
      EXPECT_LE(part, 1 + 1e-6f);
      less += part < 0.31f ? 1 : 0, full += all.cells[c].area > 0 && part > 0.999f ? 1 : 0;
    }
    EXPECT_GT(less, 300);  // atria and right ventricle
    EXPECT_GT(full, 300);
  });
}

// Frames made when they are needed give the beat of the same frames in memory, over the ends of
// blocks too.
TEST(FitFrames, MadeWhenNeededAreThoseInMemory) {
  withThreads(2, [] {
    constexpr std::size_t kCount = 13;
    const Scene scene = heart::heartScene({}, heart::View::a4c, 20, Look::scanner);
    const MeshMotion motion(scene);
    std::vector<SurfaceFrame> frames(kCount);
    for (std::size_t f = 0; f < kCount; ++f)
      motion.frameAt(static_cast<double>(f) / kCount, frames[f], false);
    const ModelPlane plane(scene, motion.surfaces());
    const ModelLoop whole = plane.cut(frames),
                    made = plane.cut(kCount,
                                     [&](std::size_t f, SurfaceFrame&out) { out = frames[f]; });
    ASSERT_EQ(made.frames.size(), kCount);
    for (std::size_t f = 0; f < kCount; ++f) {
      const ModelFrame &a = whole.frames[f], &b = made.frames[f];
      ASSERT_EQ(a.boundary.size(), b.boundary.size()) << f;
      ASSERT_GT(a.boundary.size(), 200U);
      for (std::size_t i = 0; i < a.boundary.size(); ++i) {
        ASSERT_EQ(a.boundary[i].x_m, b.boundary[i].x_m);
        ASSERT_EQ(a.boundary[i].dx_m, b.boundary[i].dx_m);
        ASSERT_EQ(a.boundary[i].dz_m, b.boundary[i].dz_m);
      }
      for (std::size_t c = 0; c < a.cells.size(); ++c) {
        ASSERT_EQ(a.cells[c].area, b.cells[c].area);
        ASSERT_EQ(a.cells[c].share, b.cells[c].share);
      }
    }
  });
}

}  // namespace
}  // namespace echocine::fit
