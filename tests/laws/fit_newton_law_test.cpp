// Slopes of a fit's cost, steps with them, and the corrected discrepancy in the cost.

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "fit/fit_descent.h"
#include "fit/own_loop.h"
#include "fit/searched_dials.h"
#include "support/drawn_heart.h"

namespace echocine::fit {
namespace {

// A family of one dial against a loop of one of its hearts, whose plane is not searched.
struct OneDial {
  const std::map<std::string, double> fixed{{"edv", 120}, {"hr", 72}};
  HeartFamily family;
  echo::EchoLoop loop;
  ModelDiscrepancy discrepancy;
  ExpectedLook look;

  OneDial()
      : family(HeartNodes(fixed, HeartDesign::polynomial({searchedDials().front().range}),
                          kFitFrames, {}),
               heart::View::a4c, {}),
        loop(OwnHeart({{"ef", 0.5}, {"edv", 120}, {"hr", 72}}, heart::View::a4c, {}, kFitFrames)
                 .beats()
                 .loop(5)),
        discrepancy(loop, support::fromTheStart(), family.at({0.5}, {}, Focus::left_ventricle)) {}

  FitCost cost() const { return {{{&family, &discrepancy, &look}}, fixed, 0}; }
};

TEST(FitNewton, StepsFollowTheSlopesOfTheCost) {
  withThreads(2, [] {
    OneDial one;
    const FitCost plain = one.cost();
    ASSERT_EQ(plain.unknowns().size(), 1u);
    const FitPlace place = plain.at({0.45}, {});
    const double step = plain.unknowns()[0].step, half = kSlopeStep * step;

    // By the cost of whole places: its prior and its view.
    const FitPlace above = plain.at({0.45 + half}, place.found),
                   below = plain.at({0.45 - half}, place.found);
    const double slope = (above.cost - below.cost) / (2 * half);
    EXPECT_LT(slope, 0);  // EF is 0.5
    EXPECT_NEAR(plain.slopesAt(place, {}).front(), slope, 1e-9 * std::abs(slope));

    // Minus covariance times slope, but no longer than a step of the unknown; then a share of it.
    const double small = 0.1 * step / std::abs(slope), large = 7 * step / std::abs(slope);
    const auto reached = [&](double covariance, double share) {
      return newtonStep(plain, place, {slope}, {covariance}, share).at[0];
    };
    EXPECT_NEAR(reached(small, 1), 0.45 + 0.1 * step, 1e-12);
    EXPECT_NEAR(reached(small, 0.25), 0.45 + 0.025 * step, 1e-12);
    EXPECT_NEAR(reached(large, 1), 0.45 + step, 1e-12);
    EXPECT_NEAR(reached(large, 0.25), 0.45 + 0.25 * step, 1e-12);

    Monitor stopping;
    stopping.keep_going = [] { return false; };
    EXPECT_THROW(plain.slopesAt(place, stopping), JobError);

    // (24) in (14): 500 ln(D - q c s (x - x_0)).
    const double d = above.found[0].discrepancy, s = 0.4, shown = 0.5;
    one.look.slope = ExpectedSlope({0.45}, {s});
    one.look.slope.scaleTo(shown);
    const FitCost corrected = one.cost();
    const FitPlace again = corrected.at(above.at, place.found);
    EXPECT_EQ(again.found[0].discrepancy, d);
    EXPECT_NEAR(again.cost - above.cost, 500 * (std::log(d - shown * s * half) - std::log(d)),
                1e-9);
    EXPECT_NEAR(corrected.at(place.at, place.found).cost, place.cost, 1e-9);
  });
}

// Differences of a plane need a step to both sides, also within a small limit.
TEST(FitNewton, StepsOfAPlaneFitIntoItsLimits) {
  withThreads(2, [] {
    OneDial one;
    for (const double most_deg : {0.5, 1.0, 3.0, 5.0, 20.0}) {
      const FitCost cost({{&one.family, &one.discrepancy, &one.look}}, one.fixed, most_deg);
      const std::vector<double> middle = cost.middleOf({0.5, most_deg, -most_deg});
      for (const std::size_t u : {1, 2}) {
        const FitUnknown& plane = cost.unknowns()[u];
        EXPECT_GE(middle[u] - plane.step, plane.low) << plane.name << ' ' << most_deg;
        EXPECT_LE(middle[u] + plane.step, plane.high) << plane.name << ' ' << most_deg;
      }
    }
  });
}

}  // namespace
}  // namespace echocine::fit
