// Blood that a loop shows as wall: areas by closed forms, and sums that stay those of squares.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/hash_random.h"
#include "fit/seen_cells.h"
#include "fit/tissue_greys.h"

namespace echocine::fit {
namespace {

constexpr double kFar_m = 0.15, kFirst_rad = -0.7, kTurn_rad = 1.4 / (kCellLines - 1),
                 kStep_m = kFar_m / kCellsAlong;

// A disc of blood (tissue 1) in muscle (tissue 0), as its cells and boundary.
ModelLoop disc(double radius_m, double deep_m) {
  ModelLoop model;
  model.tissues = {"muscle", "blood"};
  model.blood = {false, true};
  model.structures = {"disc"};
  model.far_m = kFar_m;
  model.cells_across = kCellLines, model.cells_along = kCellsAlong;
  ModelFrame frame;
  constexpr int kFine = 20;  // samples of a cell, each way
  for (int i = 0; i < kCellLines; ++i)
    for (int k = 0; k < kCellsAlong; ++k) {
      int inside = 0;
      for (int n = 0; n < kFine * kFine; ++n) {
        const double angle = kFirst_rad + (i - 0.5 + (n % kFine + 0.5) / kFine) * kTurn_rad,
                     r = (k + (n / kFine + 0.5) / kFine) * kStep_m;
        inside += std::hypot(r * std::sin(angle), r * std::cos(angle) - deep_m) < radius_m ? 1 : 0;
      }
      const double angle = kFirst_rad + i * kTurn_rad, r = (k + 0.5) * kStep_m;
      TissueCell cell;
      cell.x_m = static_cast<float>(r * std::sin(angle));
      cell.z_m = static_cast<float>(r * std::cos(angle));
      cell.area = static_cast<float>(r / kFar_m);
      cell.share = static_cast<float>(inside) / (kFine * kFine);
      cell.first = inside > 0 ? 1 : 0;
      cell.second = cell.share < 1 ? 0 : cell.first;
      if (inside == 0) cell.share = 1;
      frame.cells.push_back(cell);
    }
  const int pieces = static_cast<int>(2 * std::numbers::pi * radius_m / kBoundaryPiece_m);
  for (int n = 0; n < pieces; ++n) {
    const double turn = 2 * std::numbers::pi * n / pieces;
    BoundaryPoint p;
    p.nx = static_cast<float>(std::cos(turn)), p.nz = static_cast<float>(std::sin(turn));
    p.x_m = static_cast<float>(radius_m) * p.nx;
    p.z_m = static_cast<float>(deep_m) + static_cast<float>(radius_m) * p.nz;
    p.length_m = static_cast<float>(2 * std::numbers::pi * radius_m / pieces);
    p.of_blood = true;
    p.blood = 1, p.beside = 0;
    frame.boundary.push_back(p);
  }
  model.frames = {frame};
  return model;
}

double bloodArea_m2(const ModelLoop& model, std::span<const TissueCell> cells) {
  double sum = 0;
  for (const TissueCell& cell : cells) {
    const double share = cell.share;
    sum += cell.area * ((model.blood[cell.first] ? share : 0) +
                        (cell.second != cell.first && model.blood[cell.second] ? 1 - share : 0) +
                        (cell.second == cell.first && model.blood[cell.first] ? 1 - share : 0));
  }
  return sum * kFar_m * kTurn_rad * kStep_m;
}

TEST(FitSeen, TheStripThatIsSeenAsWallHasItsArea) {
  for (const double radius_m : {0.015, 0.025}) {
    const ModelLoop model = disc(radius_m, 0.08);
    const ModelFrame& frame = model.frames.front();
    EXPECT_NEAR(bloodArea_m2(model, frame.cells) / (std::numbers::pi * radius_m * radius_m), 1,
                0.01);
    for (const double beside_m : {0.5e-3, 1e-3, 2e-3}) {
      SeenCells seen(model);
      seen.start(frame.cells);
      for (const BoundaryPoint& p : frame.boundary) seen.take(p, beside_m);
      const double lost = bloodArea_m2(model, frame.cells) - bloodArea_m2(model, seen.cells());
      EXPECT_NEAR(lost / (2 * std::numbers::pi * radius_m * beside_m), 1, 0.03) << beside_m;
    }
  }
}

// The angle of the strip is that of the piece and a small one: the same as that of the place
// itself, also for strips as wide as their distance from the apex.
TEST(FitSeen, TheAngleOfAPieceServesAllStripsBesideIt) {
  const ModelLoop model = disc(0.02, 0.04);
  const ModelFrame& frame = model.frames.front();
  for (const double beside_m : {1e-4, 2e-3, 0.03}) {
    SeenCells seen(model), moved(model);
    seen.start(frame.cells);
    moved.start(frame.cells);
    for (const BoundaryPoint& p : frame.boundary) {
      seen.take(p, beside_m);
      // Half as far from a piece that lies a quarter of the strip back.
      BoundaryPoint q = p;
      q.x_m -= static_cast<float>(0.25 * beside_m) * p.nx;
      q.z_m -= static_cast<float>(0.25 * beside_m) * p.nz;
      q.length_m = 2 * p.length_m;
      moved.take(q, 0.5 * beside_m);
    }
    for (std::size_t c = 0; c < seen.cells().size(); ++c) {
      ASSERT_EQ(seen.cells()[c].second, moved.cells()[c].second) << beside_m << ' ' << c;
      ASSERT_NEAR(seen.cells()[c].share, moved.cells()[c].share, 1e-4) << beside_m << ' ' << c;
    }
  }
}

// Strips wider than the chamber: it nearly vanishes, and no cell has less than no blood.
TEST(FitSeen, NoStripTakesMoreBloodThanThereIs) {
  const ModelLoop model = disc(0.003, 0.11);
  SeenCells seen(model);
  seen.start(model.frames.front().cells);
  for (int round = 0; round < 4; ++round)
    for (const BoundaryPoint& p : model.frames.front().boundary) seen.take(p, 4e-3);
  for (const TissueCell& cell : seen.cells()) {
    EXPECT_GE(cell.share, 0);
    EXPECT_LE(cell.share, 1);
  }
  EXPECT_LT(bloodArea_m2(model, seen.cells()), 0.25 * std::numbers::pi * 0.003 * 0.003);
}

// In a picture of noise a wrong model explains next to nothing, and its residual is the sum of the
// squares of its cells. Strips of negative weight gave residuals down to 0.
TEST(FitSeen, AWrongModelInNoiseHasTheResidualOfItsCells) {
  for (const double radius_m : {0.006, 0.02}) {
    const ModelLoop model = disc(radius_m, 0.11);
    SeenCells seen(model);
    seen.start(model.frames.front().cells);
    for (const BoundaryPoint& p : model.frames.front().boundary) seen.take(p, 3e-3);
    TissueGreys greys(model.blood);
    const auto eachCell = [&](auto&& body) {
      std::uint64_t n = 0;
      for (const TissueCell& cell : seen.cells()) {
        body(cell, std::hypot(cell.x_m, cell.z_m) / kFar_m,
             100 + 40 * normalFromHashes(hashOf(n, 1), hashOf(n, 2)));
        ++n;
      }
    };
    eachCell([&](const TissueCell& cell, double depth, double grey) {
      greys.add(cell.first, cell.second, cell.share, depth, grey, cell.area);
    });
    const TissueGreys::Fit fit = greys.fit();
    ASSERT_TRUE(fit.solved);
    EXPECT_GT(fit.ratio(), 0.98) << radius_m;
    double sum = 0;
    eachCell([&](const TissueCell& cell, double depth, double grey) {
      const double left = fit.left(cell.first, cell.second, cell.share, depth, grey);
      if (std::isfinite(left)) sum += cell.area * left * left;
    });
    EXPECT_NEAR(sum / fit.residual, 1, 1e-6) << radius_m;
  }
}

}  // namespace
}  // namespace echocine::fit
