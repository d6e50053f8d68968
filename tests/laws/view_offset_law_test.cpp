// Planes through the long axis, turned about it: which standard view is the nearest, and how far.

#include "truth/view_offset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "core/units.h"

namespace echocine {
namespace {

// Seen from the apex: the axis towards the probe in the imaging plane's middle, and the septum so
// that the plane is turned by turn_deg from the four-chamber plane, towards the anterior wall.
ViewOffset turnedBy(double turn_deg) {
  const double turn = radiansFromDegrees(turn_deg);
  ViewLandmarks marks;
  marks.axes.base_m = {0, 0, 0.09};
  marks.axes.axis = {0, 0, -1};
  marks.axes.septal = {std::cos(turn), std::sin(turn), 0};
  marks.axes.anterior = cross(marks.axes.septal, marks.axes.axis);
  marks.axes.length_m = 0.08;
  return viewOffset(marks, {}, {});
}

// Planes have no front, so turns are within a quarter circle; standard planes are at 0, 60 and -60.
TEST(ViewOffsetLaw, APlaneIsNamedAfterTheNearestStandardOne) {
  for (int turn = -85; turn <= 85; turn += 5) {
    if (turn % 30 == 0 && turn % 60 != 0) continue;  // in the middle between two
    const ViewOffset view = turnedBy(turn);
    const int standard = turn > 30 ? 60 : turn < -30 ? -60 : 0;
    EXPECT_EQ(std::string(view.label), standard == 0  ? "a4c"
                                       : standard > 0 ? "a2c"
                                                      : "a3c")
        << turn;
    EXPECT_NEAR(view.rotation_deg.value(), turn - standard, 1e-9) << turn;
    EXPECT_NEAR(view.tilt_deg, 0, 1e-9);
    EXPECT_NEAR(view.shift_mm, 0, 1e-9);
  }
}

// A quarter turn either way is the same plane.
TEST(ViewOffsetLaw, AQuarterTurnIsFarFromTheFourChamberPlaneEitherWay) {
  for (const double turn : {-90.0, 90.0}) {
    const ViewOffset view = turnedBy(turn);
    EXPECT_NE(std::string(view.label), "a4c") << turn;
    EXPECT_NEAR(std::abs(view.rotation_deg.value()), 30, 1e-9) << turn;
  }
}

}  // namespace
}  // namespace echocine
