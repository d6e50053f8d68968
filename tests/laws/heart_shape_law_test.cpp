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

// Bow and ellipticity at end-diastole and end-systole, in healthy and failing hearts: sections have
// the dialled centre and ratio of diameters, and the area that they have without these dials.
TEST(HeartShape, SectionsHaveTheDialledCentreAndDiameters) {
  using support::sectionMoments;
  struct Case {
    double lateral, anterior, ellipticity, at_45, ef;
  };
  for (const Case& c :
       {Case{0.05, 0, 0, 0, 0.6}, Case{0, -0.07, 0, 0, 0.3}, Case{0, 0, 0.2, 0, 0.6},
        Case{0, 0, 0, -0.25, 0.45}, Case{-0.03, 0.04, -0.15, 0.1, 0.65}}) {
    SCOPED_TRACE(testing::Message() << c.lateral << ' ' << c.ellipticity << ' ' << c.at_45);
    const heart::Parameters plain = heart::parametersFrom({{"ef", c.ef}, {"twist", 0}}),
                            dialled = heart::parametersFrom({{"ef", c.ef},
                                                             {"twist", 0},
                                                             {"bow-lateral", c.lateral},
                                                             {"bow-anterior", c.anterior},
                                                             {"ellipticity", c.ellipticity},
                                                             {"ellipticity-45", c.at_45}});
    heart::LeftVentricle usual(plain), left(dialled);
    const heart::Cycle cycle(plain);
    for (const double phase : {0.0, cycle.events().aortic_closes}) {
      usual.contract(cycle.at(phase).left);
      left.contract(cycle.at(phase).left);
      const double length_m = left.apexZ() - left.ringZ();
      EXPECT_NEAR(length_m, usual.apexZ() - usual.ringZ(), 1e-12);
      for (const double zeta : {0.35, 0.5, 0.8}) {
        const auto a = sectionMoments(usual, zeta), b = sectionMoments(left, zeta);
        const double bow = length_m * std::sin(std::numbers::pi * zeta);
        EXPECT_NEAR(b.centre_m.x - a.centre_m.x, c.lateral * bow, 2e-5);
        EXPECT_NEAR(b.centre_m.y - a.centre_m.y, c.anterior * bow, 2e-5);
        EXPECT_NEAR(support::sectionDiameter(left, zeta), support::sectionDiameter(usual, zeta),
                    2e-5);
        // Stretched sections of nearly round ones: ratios multiply to first order.
        if (c.at_45 == 0) {
          EXPECT_NEAR(std::log(b.diameterRatio(0) / a.diameterRatio(0)), c.ellipticity, 1e-3);
        }
        if (c.ellipticity == 0) {
          const double turn = std::numbers::pi / 4;
          EXPECT_NEAR(std::log(b.diameterRatio(turn) / a.diameterRatio(turn)), c.at_45,
                      0.02 * std::abs(c.at_45) + 1e-3);
        }
      }
    }
  }
}

// At end-diastole the wall's thickness has the dialled ratios to that of a heart without them, and
// the septum that of its own dial.
TEST(HeartShape, TheWallHasTheDialledThickness) {
  const double apical = 0.7, lateral = 1.3, anterior = 0.8;
  const heart::LeftVentricle usual{heart::Parameters{}},
      left(heart::parametersFrom({{"apical-thickness", apical},
                                  {"lateral-thickness", lateral},
                                  {"anterior-thickness", anterior}}));
  const auto thicker = [&](double phi_deg, double zeta) {
    const double phi_rad = phi_deg * std::numbers::pi / 180;
    return left.wallThicknessAt(phi_rad, zeta) / usual.wallThicknessAt(phi_rad, zeta);
  };
  EXPECT_NEAR(thicker(180, 0.5), 1, 1e-6);
  EXPECT_NEAR(thicker(0, 0.5), lateral, 1e-6);
  for (const double phi_deg : {0.0, 75.0, 180.0, 300.0})
    EXPECT_NEAR(thicker(phi_deg, 2.0 / 3) / thicker(phi_deg, 1.0 / 3), apical, 1e-6) << phi_deg;
  EXPECT_NEAR(thicker(90, 0.5) / thicker(270, 0.5), anterior, 1e-6);
}

// Normals of stretched sections are those of their outline: the wall is as thick across it.
TEST(HeartShape, TheWallGrowsAlongNormalsOfStretchedSections) {
  const heart::LeftVentricle left(heart::parametersFrom({{"ellipticity", 0.3}}));
  const heart::LeftVentricle usual{heart::Parameters{}};
  const auto nearest = [](const heart::LeftVentricle& v, const heart::WallPlace& at) {
    const Vec3d p = v.wallPoint(at);
    double least = INFINITY;
    for (int i = -200; i <= 200; ++i)
      for (int j = -20; j <= 20; ++j)
        least = std::min(least, length(p - v.cavityAt(at.phi_rad + i * 0.004, at.zeta + j * 0.01)));
    return least;
  };
  for (const double phi_rad : {0.1, 0.8, 2.3, 4.0}) {
    const heart::WallPlace at =
        heart::wallPlaceOf({0.9 * std::cos(phi_rad), 0.9 * std::sin(phi_rad), 0.4359});
    EXPECT_NEAR(nearest(left, at), nearest(usual, at), 0.03 * nearest(usual, at)) << phi_rad;
  }
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
