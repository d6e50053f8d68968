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

}  // namespace
}  // namespace echocine::fit
