// Functions of lanes: the library's, within their stated errors, and those of scalars.

#include <gtest/gtest.h>

#include <cmath>

#include "core/lanes.h"
#include "core/rough_angle.h"

namespace echocine {
namespace {

TEST(Lanes, TheExponentialOfLanesIsThatOfTheLibrary) {
  for (int i = 0; i < 2000; ++i) {
    float x[kFloatLanes] = {}, y[kFloatLanes];
    for (std::size_t k = 0; k < kFloatLanes; ++k)
      x[k] = static_cast<float>(-86 + 0.0107 * (8 * i + static_cast<int>(k)));
    store(exponential(lanesAt(x)), y);
    for (std::size_t k = 0; k < kFloatLanes; ++k) {
      const double right = std::exp(static_cast<double>(x[k]));
      ASSERT_NEAR(static_cast<double>(y[k]), right, 2e-7 * right) << x[k];
    }
  }
}

TEST(Lanes, TheRoughAngleOfLanesIsThatOfScalars) {
  for (int i = 0; i < 400; ++i) {
    const double turn = 0.0157 * i, near = 1e-9 + 0.001 * i;
    const Doubles4 x{near * std::sin(turn), 0, -near, near},
        z{near * std::cos(turn), near, 0, -0.5};
    const Doubles4 angles = roughAngle(x, z);
    for (std::size_t k = 0; k < kDoubleLanes; ++k) {
      ASSERT_EQ(angles[k], roughAngle(x[k], z[k])) << x[k] << ' ' << z[k];
      ASSERT_NEAR(angles[k], std::atan2(x[k], z[k]), 1.2e-5) << x[k] << ' ' << z[k];
    }
  }
}

}  // namespace
}  // namespace echocine
