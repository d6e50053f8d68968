// The polish of a fit: regressions through places about the best one.

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "fit/fit_polish.h"
#include "fit/own_loop.h"
#include "fit/searched_dials.h"
#include "support/drawn_heart.h"

namespace echocine::fit {
namespace {

// At a limit of the ejection fraction, a covariance whose short axis runs across it: half of the
// draws are moved to the limit, many short SDs from the best place. The polish still ends at a
// place that is no worse, within the limits.
TEST(FitPolish, KeepsEnoughPlacesAtALimit) {
  withThreads(2, [] {
    const std::map<std::string, double> fixed{{"edv", 120}, {"hr", 72}};
    constexpr double kTilt_deg = 8;
    const HeartNodes hearts(fixed, HeartDesign::polynomial({searchedDials().front().range}),
                            kFitFrames, {});
    const HeartFamily family(hearts, heart::View::a4c, {}, kTilt_deg);
    const double low = searchedDials().front().range.low;
    const echo::EchoLoop loop =
        OwnHeart({{"ef", low + 0.02}, {"edv", 120}, {"hr", 72}}, heart::View::a4c, {}, kFitFrames)
            .beats()
            .loop(5);
    const ModelDiscrepancy discrepancy(loop, support::fromTheStart(),
                                       family.at({0.4}, {}, Focus::left_ventricle));
    const ExpectedLook look;
    const FitCost cost({{&family, &discrepancy, &look}}, fixed, kTilt_deg);
    ASSERT_EQ(cost.unknowns().size(), 3u);
    FitDescent from;
    from.best = cost.at({low, 0, 0}, {});
    // In steps: SDs of 1, of 0.002 across the line along which all three grow together.
    constexpr double kShort = 0.002;
    from.covariance.resize(9);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        from.covariance[3 * i + j] = (1 + (i == j ? kShort * kShort : 0)) *
                                     cost.unknowns()[i].step * cost.unknowns()[j].step;
    const FitDescent polished = polishFit(cost, from, {}, 2);
    EXPECT_FALSE(polished.stopped);
    EXPECT_LE(polished.best.cost, from.best.cost);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_GE(polished.best.at[i], cost.unknowns()[i].low);
      EXPECT_LE(polished.best.at[i], cost.unknowns()[i].high);
      EXPECT_GT(polished.covariance[4 * i], 0);
    }
  });
}

}  // namespace
}  // namespace echocine::fit
