// The dials of the left ventricle's shape: sections of its cavity have the dialled conicity, and
// their motion the dialled ratio.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "motion/heart/heart_cycle.h"
#include "support/ventricle_sections.h"

namespace echocine {
namespace {

using heart::kApicalHeight, heart::kBasalHeight;

struct ShapeDials {
  double conicity, apical_motion, ef;
};

class HeartShapeLaw : public testing::TestWithParam<ShapeDials> {};

TEST_P(HeartShapeLaw, SectionsHaveTheDialledRatios) {
  const ShapeDials& dials = GetParam();
  const heart::Parameters parameters = heart::parametersFrom(
      {{"conicity", dials.conicity}, {"apical-motion", dials.apical_motion}, {"ef", dials.ef}});
  heart::LeftVentricle left(parameters);
  const heart::Cycle cycle(parameters);
  const double base_m = support::sectionDiameter(left, kBasalHeight),
               apex_m = support::sectionDiameter(left, kApicalHeight);
  EXPECT_NEAR(apex_m / base_m, dials.conicity, 1e-4);
  left.contract(cycle.at(cycle.events().aortic_closes).left);
  const double base_motion = 1 - support::sectionDiameter(left, kBasalHeight) / base_m,
               apical_motion = 1 - support::sectionDiameter(left, kApicalHeight) / apex_m;
  EXPECT_NEAR(apical_motion / base_motion, dials.apical_motion, 0.01 * dials.apical_motion);
}

INSTANTIATE_TEST_SUITE_P(Shapes, HeartShapeLaw,
                         testing::Values(ShapeDials{0.71, 1, 0.6}, ShapeDials{0.55, 1, 0.4},
                                         ShapeDials{0.95, 1, 0.6}, ShapeDials{0.71, 0.7, 0.55},
                                         ShapeDials{0.71, 1.5, 0.65}, ShapeDials{0.60, 1.3, 0.25},
                                         ShapeDials{0.85, 0.75, 0.7}));

// Without the dial the ventricle has the outline's own conicity: the same points.
TEST(HeartShape, TheDefaultIsTheOutlinesOwnConicity) {
  const heart::LeftVentricle usual{heart::Parameters{}},
      dialled(heart::parametersFrom({{"conicity", heart::outlineConicity()}}));
  const std::vector<Vec3d> a = usual.wallPoints(), b = dialled.wallPoints();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LT(length(a[i] - b[i]), 1e-15) << i;
  EXPECT_NEAR(heart::outlineConicity(), 0.71, 0.005);  // as the dial's description states
}

// Against a meridian that is computed from tapered knots.
TEST(HeartShape, TheSizeOfATaperedOutlineIsThatOfItsMeridian) {
  for (const double taper : {-0.35, -0.1, 0.0, 0.2, 0.35}) {
    std::vector<std::pair<double, double>> squares;
    constexpr int kKnots = 2000;
    const double low = heart::wallOutline().lowest();
    for (int i = 0; i <= kKnots; ++i) {
      const double zeta = low + (1 - low) * i / kKnots;
      const double rho = heart::wallOutline().rhoAt(zeta) * std::exp(taper * heart::leanOf(zeta));
      squares.emplace_back(zeta, i == 0 || i == kKnots ? 0 : rho * rho);
    }
    const heart::Meridian meridian(squares);
    const heart::OutlineSize size = heart::outlineSize(taper);
    EXPECT_NEAR(size.volume, meridian.volume(), 2e-4 * size.volume) << taper;
    EXPECT_NEAR(size.widest, meridian.widest(), 2e-4 * size.widest) << taper;
    constexpr double kStep = 1e-5;
    const heart::OutlineSize more = heart::outlineSize(taper + kStep),
                             less = heart::outlineSize(taper - kStep);
    EXPECT_NEAR(size.volume_slope, std::log(more.volume / less.volume) / (2 * kStep), 1e-6);
    EXPECT_NEAR(size.widest_slope, std::log(more.widest / less.widest) / (2 * kStep), 1e-4);
  }
}

}  // namespace
}  // namespace echocine
