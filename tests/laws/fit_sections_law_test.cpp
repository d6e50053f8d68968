// Dials of the ventricle's sections in a fit: held at first, then searched with the others.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/parallel.h"
#include "fit/fit_polish.h"
#include "fit/own_loop.h"
#include "fit/searched_dials.h"
#include "support/drawn_heart.h"

namespace echocine::fit {
namespace {

constexpr double kPlantedEf = 0.5, kPlantedEllipticity = 0.2;

// A family of two dials against a loop of one of its hearts, in the view's own plane. The
// parasternal short axis shows the ratio of the diameters.
struct TwoDials {
  const std::map<std::string, double> fixed{{"edv", 120}, {"hr", 72}};
  HeartFamily family;
  echo::EchoLoop loop;
  ModelDiscrepancy discrepancy;
  ExpectedLook look;

  TwoDials()
      : family(HeartNodes(fixed,
                          HeartDesign::polynomial({{"ef", 0.35, 0.65}, {"ellipticity", -0.3, 0.3}}),
                          kFitFrames, {}),
               heart::View::psax_mid, {}),
        loop(OwnHeart({{"ef", kPlantedEf},
                       {"ellipticity", kPlantedEllipticity},
                       {"edv", 120},
                       {"hr", 72}},
                      heart::View::psax_mid, {}, kFitFrames)
                 .beats()
                 .loop(5)),
        discrepancy(loop, support::fromTheStart(),
                    family.at({kPlantedEf, 0}, {}, Focus::left_ventricle)) {}

  FitCost cost() const { return {{{&family, &discrepancy, &look}}, fixed, 0}; }
};

TEST(FitSections, AreHeldUntilTheyAreSearched) {
  withThreads(2, [] {
    const TwoDials two;
    FitCost cost = two.cost();
    ASSERT_EQ(cost.unknowns().size(), 2u);
    EXPECT_EQ(cost.unknownsOf(0), (std::vector<std::size_t>{0, 1}));
    EXPECT_EQ(cost.freeOf(0), std::vector<std::size_t>{0});
    const std::vector<double> from{0.42, 0.05};
    EXPECT_EQ(cost.moved(from, {1, 1})[1], from[1]);
    EXPECT_EQ(cost.middleOf({0.42, 0.3})[1], 0.3);
    const auto [low, high] = cost.besideIn(1, from);
    EXPECT_EQ(low, high);
    const FitPlace place = cost.at(from, {});
    EXPECT_EQ(cost.slopesAt(place, {})[1], 0);

    FitDescent descent = descendFit(cost, place, {});
    EXPECT_EQ(descent.best.at[1], from[1]);
    EXPECT_LT(descent.best.cost, place.cost);
    // The prior alone determines a held dial.
    EXPECT_NEAR(std::sqrt(descent.covariance[3]), *cost.prior().sdOf("ellipticity"), 1e-6);
    EXPECT_EQ(descent.covariance[1], 0);
    descent = polishFit(cost, std::move(descent), {}, 1);
    EXPECT_EQ(descent.best.at[1], from[1]);

    cost.searchSections();
    EXPECT_EQ(cost.freeOf(0), cost.unknownsOf(0));
    EXPECT_LT(cost.slopesAt(descent.best, {})[1], 0);  // the loop's is larger
    const FitDescent found = polishFit(cost, descent, {}, 3);
    EXPECT_LT(found.best.cost, descent.best.cost);
    EXPECT_NEAR(found.best.at[1], kPlantedEllipticity, 0.07);
    EXPECT_NEAR(found.best.at[0], kPlantedEf, 0.03);
    EXPECT_LT(std::sqrt(found.covariance[3]), 0.7 * *cost.prior().sdOf("ellipticity"));
  });
}

// Distance of one model's boundaries of a structure from those of another, m: the 95 % quantile,
// because pieces beside a third structure may have no counterpart.
double distance_m(const ModelLoop& model, const ModelLoop& other, const std::string& structure) {
  std::vector<double> all;
  for (std::size_t f = 0; f < model.frames.size(); ++f)
    for (const BoundaryPoint& p : model.frames[f].boundary) {
      if (model.structures[p.surface] != structure) continue;
      double least = INFINITY;
      for (const BoundaryPoint& q : other.frames[f].boundary) {
        if (q.surface != p.surface) continue;
        const double x = static_cast<double>(p.x_m - q.x_m), z = static_cast<double>(p.z_m - q.z_m),
                     off = x * static_cast<double>(q.nx) + z * static_cast<double>(q.nz);
        if (std::hypot(x, z) < 2e-3) least = std::min(least, std::abs(off));
      }
      all.push_back(least);
    }
  std::sort(all.begin(), all.end());
  return all.at(all.size() * 95 / 100);
}

// Surfaces are nearly linear in these dials, so a polynomial of degree 1 in them, alone and times
// ejection fraction and volume, has the surfaces of computed hearts.
TEST(FitSections, AFamilyHasTheSurfacesOfComputedHearts) {
  withThreads(2, [] {
    const std::vector<DialRange> ranges{{"ef", 0.35, 0.65},
                                        {"edv", 90, 180},
                                        {"ellipticity", -0.3, 0.3},
                                        {"bow-anterior", -0.06, 0.06},
                                        {"lateral-thickness", 0.7, 1.3}};
    const HeartNodes hearts({{"hr", 72}}, HeartDesign::polynomial(ranges), 4, {});
    EXPECT_EQ(hearts.size(), 23u);  // 10 terms of two dials, three of each other, and a fifth more
    const HeartFamily family(hearts, heart::View::a4c);
    for (const std::vector<double>& at : {std::vector<double>{0.55, 120, 0.12, 0.02, 1.15},
                                          std::vector<double>{0.42, 150, -0.15, -0.03, 0.85}}) {
      std::map<std::string, double> dials{{"hr", 72}};
      for (std::size_t i = 0; i < ranges.size(); ++i) dials[ranges[i].key] = at[i];
      // A family between two nodes has the computed heart of the first one.
      const double twist = heart::parametersFrom(dials).twist_deg;
      const HeartFamily computed(dials, {{"twist", twist, twist + 1}}, heart::View::a4c, 4, 2);
      const ModelLoop blended = family.at(at), own = computed.at({twist});
      const double cavity_m = distance_m(blended, own, "lv_cavity"),
                   wall_m = distance_m(blended, own, "lv_wall");
      std::printf("  cavity within %.2f mm, wall within %.2f mm\n", 1e3 * cavity_m, 1e3 * wall_m);
      EXPECT_LT(cavity_m, 0.3e-3);
      EXPECT_LT(wall_m, 0.4e-3);
    }
  });
}

}  // namespace
}  // namespace echocine::fit
