// The model error of intervals (Eq. 23).

#include "fit/fit_interval.h"

#include <gtest/gtest.h>

namespace echocine::fit {
namespace {

TEST(FitInterval, TheModelErrorGrowsWhereLoopsDisagreeWithOwnLoops) {
  for (std::size_t views = 1; views <= kMostLoops; ++views)
    for (const auto one : {&ModelError::ef, &ModelError::edv, &ModelError::gls}) {
      const double family = modelErrorOf(views, 1).*one, none = modelErrorOf(views, 0).*one;
      EXPECT_GT(family, 0);
      double before = family;
      for (int i = 9; i >= 0; --i) {
        const double a = 0.1 * i, at = modelErrorOf(views, a).*one;
        EXPECT_GT(at, before);
        // Independent errors: variances add.
        EXPECT_NEAR(at * at, family * family + (1 - a) * (1 - a) * (none * none - family * family),
                    1e-12);
        before = at;
      }
      EXPECT_EQ(modelErrorOf(views, {}).*one, modelErrorOf(views, 0.5).*one);  // not measured
      EXPECT_EQ(modelErrorOf(views, 1.5).*one, family);
      EXPECT_EQ(modelErrorOf(views, -1).*one, none);
      // A further view has no larger error of the family.
      if (views > 1) {
        EXPECT_LE(family, modelErrorOf(views - 1, 1).*one);
      }
    }
}

}  // namespace
}  // namespace echocine::fit
