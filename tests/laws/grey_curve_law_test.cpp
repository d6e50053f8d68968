// Laws of the grey map: end points, black toe, monotone, continuous slope, closed-form inverse.

#include "scene/grey_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "plan/effect_plan.h"
#include "scene/ranges.h"
#include "scene/white_rule.h"
#include "signal/scan_conversion.h"
#include "support/scene_text.h"

namespace echocine {
namespace {

using namespace support;

struct CurveShape {
  double toe, shoulder, gamma;
};

std::vector<CurveShape> curveShapes() {
  std::vector<CurveShape> shapes;
  for (const double toe : {0.0, 0.04, 0.1, ranges::kGreyToe.hi})
    for (const double shoulder : {0.0, 0.15, ranges::kGreyShoulder.hi})
      for (const double gamma : {0.5, 1.0, 1.9}) shapes.push_back({toe, shoulder, gamma});
  return shapes;
}

SignalSettings withShape(const CurveShape& shape) {
  SignalSettings signal;
  signal.grey_toe = shape.toe;
  signal.grey_shoulder = shape.shoulder;
  signal.grey_gamma = shape.gamma;
  return signal;
}

TEST(GreyCurveLaw, EndsAtBlackAndWhiteAndNeverFalls) {
  for (const CurveShape& shape : curveShapes()) {
    const GreyCurve curve(withShape(shape));
    EXPECT_EQ(curve.at(0), 0);
    EXPECT_EQ(curve.at(-0.5), 0);
    EXPECT_EQ(curve.at(1), 1);
    EXPECT_EQ(curve.at(1.5), 1);
    for (int i = 1; i <= 4000; ++i) EXPECT_GE(curve.at(i / 4000.0), curve.at((i - 1) / 4000.0));
  }
}

// Law: exactly the lowest share `toe` of the range is 0; above it the grey rises.
TEST(GreyCurveLaw, TheToeIsTheShareOfTheRangeThatIsBlack) {
  for (const CurveShape& shape : curveShapes()) {
    const GreyCurve curve(withShape(shape));
    EXPECT_EQ(curve.at(shape.toe), 0);
    EXPECT_GT(curve.at(shape.toe + 0.001), 0);
    EXPECT_NEAR(curve.inverse(0), shape.toe, 1e-15);
  }
}

// Closed form of the integral of the trapezoid of slopes, by a sum over the range.
TEST(GreyCurveLaw, IsTheIntegralOfATrapezoidOfSlopes) {
  constexpr int kSteps = 200'000;
  for (CurveShape shape : curveShapes()) {
    shape.gamma = 1;
    const GreyCurve curve(withShape(shape));
    const double a = 1 / (1 - 1.5 * shape.toe - 0.5 * shape.shoulder);
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double x = (i + 0.5) / kSteps;
      const double rise = shape.toe > 0 ? std::clamp((x - shape.toe) / shape.toe, 0.0, 1.0) : 1;
      const double fall = shape.shoulder > 0 ? std::min((1 - x) / shape.shoulder, 1.0) : 1;
      sum += a * std::min(rise, fall) / kSteps;
      if (i % 1000 == 999) {
        EXPECT_NEAR(curve.at((i + 1.0) / kSteps), sum, 1e-5);
      }
    }
  }
}

TEST(GreyCurveLaw, TheInverseGivesThePlaceBackAboveTheToe) {
  for (const CurveShape& shape : curveShapes()) {
    const GreyCurve curve(withShape(shape));
    for (double x = shape.toe + 0.003; x < 1; x += 0.0031)
      EXPECT_NEAR(curve.inverse(curve.at(x)), x, 2e-7);
    for (double grey = 0.001; grey <= 1; grey += 0.0017)
      EXPECT_NEAR(curve.at(curve.inverse(grey)), grey, 1e-9);
  }
}

TEST(GreyCurveLaw, WithoutToeAndShoulderItIsThePowerLaw) {
  EXPECT_TRUE(GreyCurve(SignalSettings{}).isIdentity());
  for (const double gamma : {0.5, 1.0, 1.2, 3.0}) {
    const GreyCurve curve(withShape({0, 0, gamma}));
    for (double x = 0; x <= 1; x += 0.01) EXPECT_EQ(curve.at(x), std::pow(x, gamma));
  }
}

TEST(GreyCurveLaw, MuscleKeepsItsGrey) {
  for (const CurveShape& shape : curveShapes()) {
    SignalSettings signal = withShape(shape);
    signal.dynamic_range_db = 72;
    const double below_db = 10 * std::log10(whiteOverMuscle(signal));
    EXPECT_NEAR(255 * GreyCurve(signal).at(1 - below_db / 72), kMuscleGrey, 1e-6);
  }
}

// Law: pixels are 255 g, rounded; those in the toe are exactly 0.
TEST(GreyCurveLaw, PicturesFollowTheCurve) {
  const Scene scene = parsed(SceneText::oneBox("blood"));
  const GreyCurve curve(withShape({0.1, 0.2, 1.3}));
  const PictureGeometry geometry = pictureGeometry(scene);
  const ScanConverter converter(scene.probe, geometry, 160, 120, curve);
  const auto count = static_cast<std::size_t>(scene.probe.lines * scene.probe.samples);
  for (const float x : {0.02f, 0.1f, 0.13f, 0.4f, 0.9f, 1.0f}) {
    GreyImage image;
    converter.convert(std::vector<float>(count, x), image);
    const int brightest = *std::max_element(image.pixels.begin(), image.pixels.end());
    EXPECT_NEAR(brightest, 255 * curve.at(static_cast<double>(x)), 0.6);
    if (x <= 0.1f) {
      EXPECT_EQ(brightest, 0);
    }
  }
}

TEST(GreyCurveLaw, ThePlanTellsWhetherTheMapIsStraight) {
  SceneText text = SceneText::oneBox("blood");
  EXPECT_FALSE(planEffects(parsed(text)).decision(Effect::grey_map).on);
  text.signal["grey_toe"] = "0.1";
  EXPECT_TRUE(planEffects(parsed(text)).decision(Effect::grey_map).on);
  text.signal["grey_toe"] = "0.31";
  EXPECT_THROW(parsed(text), SceneError);
}

}  // namespace
}  // namespace echocine
