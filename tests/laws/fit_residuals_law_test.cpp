// Residuals of the discrepancy: their squares sum to it, and their columns are its slopes.

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <opencv2/core.hpp>

#include "core/error.h"
#include "core/hash_random.h"
#include "core/parallel.h"
#include "fit/fit_residuals.h"
#include "support/drawn_heart.h"

namespace echocine::fit {
namespace {

using namespace support;

const ModelDiscrepancy& drawnLoop() {
  static const ModelDiscrepancy d(draw(Phantom{}, {}, 20, 33), fromTheStart(), Phantom{}.model());
  return d;
}

// Growth in mm, and beat.
ModelLoop phantomOf(const std::vector<double>& at) {
  return Phantom{.grow_m = 1e-3 * at[0], .beat = at[1]}.model();
}
const std::vector<double> kSteps{0.3, 0.02};

double squareOf(const std::vector<double>& r) {
  return std::inner_product(r.begin(), r.end(), r.begin(), 0.0);
}

TEST(FitResiduals, TheirSquaresSumToTheDiscrepancy) {
  withThreads(2, [] {
    std::size_t size = 0;
    for (const double grow : {-1.0, 0.0, 2.0})
      for (const FitPose pose : {FitPose{}, FitPose{0.012, -0.005, 0.1, 1.05}}) {
        const ModelLoop model = phantomOf({grow, 0.15});
        const std::vector<double> r = residualsOf(drawnLoop(), model, pose);
        EXPECT_NEAR(squareOf(r), 1 + drawnLoop().at(model, pose).discrepancy, 1e-9);
        // The rest has little more than its constant, so what fits is in the residuals.
        EXPECT_NEAR(r.back() * r.back(), 1, 0.35);
        if (size > 0) {
          EXPECT_EQ(r.size(), size);
        }
        size = r.size();
      }
    EXPECT_EQ(size,
              static_cast<std::size_t>(kFrames * (kCellLines * kCellsAlong + 2 * 3 * kSides) + 1));
  });
}

// Also where pieces have weights and edges inside or outside the blood, and cells expected greys.
TEST(FitResiduals, WeightedPiecesAndExpectedGreysSumToTheDiscrepancyToo) {
  withThreads(2, [] {
    ModelLoop model = phantomOf({1, 0.15});
    const FitPose pose{0.004, -0.003, 0.05, 1.01};
    const double even = drawnLoop().at(model, pose).discrepancy;
    std::uint64_t number = 0;
    for (ModelFrame& frame : model.frames) {
      for (TissueCell& cell : frame.cells)
        cell.expected = static_cast<float>(20 * uniformFromHash(hashOf(number++, 3, 5)) - 10);
      for (BoundaryPoint& p : frame.boundary) {
        p.weight = static_cast<float>(uniformFromHash(hashOf(number, 1, 5)));
        p.alone = static_cast<float>(uniformFromHash(hashOf(number++, 2, 5)));
        p.inside_m = static_cast<float>(3e-3 - 6e-3 * uniformFromHash(hashOf(number, 4, 5)));
      }
    }
    const double weighted = drawnLoop().at(model, pose).discrepancy;
    EXPECT_GT(std::abs(weighted - even), 1e-4);
    EXPECT_NEAR(squareOf(residualsOf(drawnLoop(), model, pose)), 1 + weighted, 1e-9);
  });
}

// J^T r is half the slope of D: by finite differences of D itself, of other widths.
TEST(FitResiduals, ColumnsAreTheSlopesOfTheDiscrepancy) {
  withThreads(2, [] {
    const std::vector<double> at{1.5, 0.1};
    const FitPose pose{0.004, -0.003, 0.05, 1.01};
    const ResidualColumns made = residualColumns(drawnLoop(), phantomOf, at, kSteps, pose);
    ASSERT_EQ(made.columns.size(), 6u);
    const auto valueAt = [&](std::size_t u, double step) {
      std::vector<double> model = at;
      FitPose moved = pose;
      if (u < 2) model[u] += step;
      if (u == 2) moved.shift_x_m += step;
      if (u == 3) moved.shift_z_m += step;
      if (u == 4) moved.turn_rad += step;
      if (u == 5) moved.scale += step;
      return drawnLoop().at(phantomOf(model), moved).discrepancy;
    };
    const double steps[] = {0.6, 0.03, 1e-3, 1e-3, 0.015, 0.01};
    for (std::size_t u = 0; u < 6; ++u) {
      const std::vector<double>& column = made.columns[u];
      const double slope = 2 * std::inner_product(column.begin(), column.end(), made.values.begin(),
                                                  0.0),
                   wanted = (valueAt(u, steps[u]) - valueAt(u, -steps[u])) / (2 * steps[u]);
      std::printf("unknown %zu: slope %.5g by columns, %.5g by differences\n", u, slope, wanted);
      EXPECT_NEAR(slope, wanted, 0.15 * std::abs(wanted) + 0.004 / steps[u]) << u;
    }
  });
}

// Levenberg-Marquardt with the columns alone goes down to a minimum of D.
TEST(FitResiduals, AnOptimiserFindsThePlantedHeart) {
  withThreads(2, [] {
    std::vector<double> at{2.5, 0.08};
    FitPose pose{0.004, -0.003, 0.04, 1};
    double cost = 10, damping = 1e-3;
    for (int round = 0; round < 8; ++round) {
      const ResidualColumns made = residualColumns(drawnLoop(), phantomOf, at, kSteps, pose);
      cost = squareOf(made.values) - 1;
      constexpr int kFree = 5;  // the scale is known
      cv::Mat a(kFree, kFree, CV_64F), b(kFree, 1, CV_64F), x;
      for (int i = 0; i < kFree; ++i) {
        const std::vector<double>& own = made.columns[static_cast<std::size_t>(i)];
        b.at<double>(i) = -std::inner_product(own.begin(), own.end(), made.values.begin(), 0.0);
        for (int j = 0; j < kFree; ++j)
          a.at<double>(i, j) = std::inner_product(
              own.begin(), own.end(), made.columns[static_cast<std::size_t>(j)].begin(), 0.0);
      }
      for (int i = 0; i < kFree; ++i) a.at<double>(i, i) *= 1 + damping;
      ASSERT_TRUE(cv::solve(a, b, x, cv::DECOMP_CHOLESKY));
      const std::vector<double> next{at[0] + x.at<double>(0), at[1] + x.at<double>(1)};
      const FitPose moved{pose.shift_x_m + x.at<double>(2), pose.shift_z_m + x.at<double>(3),
                          pose.turn_rad + x.at<double>(4), 1};
      if (drawnLoop().at(phantomOf(next), moved).discrepancy < cost) {
        at = next, pose = moved;
        damping *= 0.3;
      } else {
        damping *= 10;
      }
    }
    std::printf("growth %.2f mm, beat %.3f, shift %.2f, %.2f mm, turn %.3f rad, D %.4f\n", at[0],
                at[1], 1e3 * pose.shift_x_m, 1e3 * pose.shift_z_m, pose.turn_rad, cost);
    EXPECT_NEAR(at[0], 0, 0.7);  // D of a drawn heart is biased by half a millimetre
    EXPECT_NEAR(at[1], 0.15, 0.03);
    EXPECT_NEAR(1e3 * pose.shift_x_m, 0, 0.5);
    EXPECT_NEAR(1e3 * pose.shift_z_m, 0, 0.5);
    EXPECT_LT(cost, drawnLoop().at(Phantom{}.model(), {}).discrepancy + 0.005);
  });
}

TEST(FitResiduals, WrongStepsAreRefusedInOneLine) {
  for (const std::vector<double>& steps :
       {std::vector<double>{0.1}, {0.1, 0.0}, {0.1, -1.0}, {0.1, std::nan("")}})
    EXPECT_THROW(residualColumns(drawnLoop(), phantomOf, {0, 0.15}, steps, {}), SceneError);
  FitPose pose;
  pose.scale = 0;
  EXPECT_THROW(residualsOf(drawnLoop(), Phantom{}.model(), pose), SceneError);
}

}  // namespace
}  // namespace echocine::fit
