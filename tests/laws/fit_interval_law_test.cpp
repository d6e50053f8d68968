// The model error of intervals (Eq. 23).

#include "fit/fit_interval.h"

#include <gtest/gtest.h>

namespace echocine::fit {
namespace {

TEST(FitInterval, TheModelErrorGrowsWhereLoopsDisagreeWithOwnLoops) {
  for (std::size_t views = 1; views <= kMostLoops; ++views)
    for (const bool own_look : {false, true})
      for (const auto one : {&ModelError::ef, &ModelError::edv, &ModelError::gls}) {
        const auto at = [&](std::optional<double> a) {
          return modelErrorOf(views, own_look, a).*one;
        };
        const double family = at(1), none = at(0);
        EXPECT_GT(family, 0);
        double before = family;
        for (int i = 9; i >= 0; --i) {
          const double a = 0.1 * i;
          EXPECT_GT(at(a), before);
          // Independent errors: variances add.
          EXPECT_NEAR(at(a) * at(a),
                      family * family + (1 - a) * (1 - a) * (none * none - family * family), 1e-12);
          before = at(a);
        }
        EXPECT_EQ(at({}), at(0.5));  // not measured
        EXPECT_EQ(at(1.5), family);
        EXPECT_EQ(at(-1), none);
        // Neither a further view nor the own look enlarges the error of the family.
        if (views > 1) {
          EXPECT_LE(family, modelErrorOf(views - 1, own_look, 1).*one);
        }
        EXPECT_LE(modelErrorOf(views, true, 1).*one, modelErrorOf(views, false, 1).*one);
      }
}

// The lag is an independent error of motion, not of size.
TEST(FitInterval, TheModelErrorGrowsWithTheLagOfPersistence) {
  std::vector<ViewFitted> views(2);
  views[0].persistence = 0.8;  // 4 frames
  views[0].beat.span.frames = 25;
  views[1].beat.span.frames = 40;  // unknown persistence
  EXPECT_NEAR(lagBeatsOf(views), 0.5 * 4 / 25, 1e-12);
  EXPECT_EQ(lagBeatsOf({}), 0);
  const ModelError none = modelErrorOf(1, false, 0.7), lag = modelErrorOf(1, false, 0.7, 0.08);
  EXPECT_NEAR(lag.ef * lag.ef, none.ef * none.ef + 0.36 * 0.08 * 0.08, 1e-12);
  EXPECT_NEAR(lag.gls * lag.gls, none.gls * none.gls + 0.35 * 0.35 * 0.08 * 0.08, 1e-12);
  EXPECT_EQ(lag.edv, none.edv);
}

}  // namespace
}  // namespace echocine::fit
