// Weights of the four kinds of interpolation in hand-made cases, and what is refused.

#include "motion/keyframes/interpolation.h"

#include <numbers>
#include <numeric>

#include "tests/stage/motion_fixtures.h"

namespace echocine::motion_test {
namespace {

std::vector<double> weightsAt(const KeyframeWeights& weights, double phase) {
  std::vector<double> values(weights.keyframeCount());
  weights.at(phase, values);
  return values;
}

std::string says(const std::vector<double>& phases, Interpolation kind) {
  return errorOf([&] { KeyframeWeights(phases, kind, {"scene.toml", 3, "motion"}); });
}

TEST(MotionInterpolation, OneKeyframeHasWeightOne) {
  for (const Interpolation kind : kInterpolations)
    for (const double phase : {0.0, 0.3, 0.999})
      EXPECT_EQ(weightsAt(KeyframeWeights(std::vector{0.25}, kind), phase)[0], 1.0);
}

TEST(MotionInterpolation, TwoEvenKeyframesMeetHalfwayInEveryKindButTheHearts) {
  for (const Interpolation kind : kInterpolations) {
    if (kind == Interpolation::cycle) continue;
    const KeyframeWeights weights(std::vector{0.0, 0.5}, kind);
    for (const double phase : {0.25, 0.75})
      for (const double weight : weightsAt(weights, phase)) EXPECT_NEAR(weight, 0.5, 1e-15);
  }
}

TEST(MotionInterpolation, TwoFourierKeyframesAreACosine) {
  const KeyframeWeights weights(std::vector{0.0, 0.5}, Interpolation::fourier);
  for (double phase = 0; phase < 1; phase += 0.07)
    EXPECT_NEAR(weightsAt(weights, phase)[0], 0.5 + 0.5 * std::cos(2 * std::numbers::pi * phase),
                1e-14);
}

TEST(MotionInterpolation, LinearBlendsTheTwoNeighboursAlsoAroundTheEnd) {
  const KeyframeWeights weights(std::vector{0.1, 0.4, 0.8}, Interpolation::linear);
  EXPECT_NEAR(weightsAt(weights, 0.2)[1], 1.0 / 3, 1e-15);
  EXPECT_NEAR(weightsAt(weights, 0.95)[2], 0.5, 1e-15);
  EXPECT_NEAR(weightsAt(weights, 0.95)[0], 0.5, 1e-15);
  EXPECT_NEAR(weightsAt(weights, 0.05)[0], 1 - 0.05 / 0.3, 1e-15);
}

TEST(MotionInterpolation, EvenCatmullRomHasItsTextbookWeights) {
  const KeyframeWeights weights(std::vector{0.0, 0.2, 0.4, 0.6, 0.8}, Interpolation::catmull_rom);
  const double expected[] = {-1.0 / 16, 9.0 / 16, 9.0 / 16, -1.0 / 16, 0.0};
  const std::vector<double> halfway = weightsAt(weights, 0.3);
  for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(halfway[k], expected[k], 1e-15);
}

TEST(MotionInterpolation, CheapFormHasFewTerms) {
  std::vector<double> phases(25);
  for (std::size_t k = 0; k < phases.size(); ++k) phases[k] = static_cast<double>(k) / 25;
  std::vector<KeyframeWeights::Term> terms;
  for (const Interpolation kind : kInterpolations) {
    const KeyframeWeights weights(phases, kind);
    weights.termsAt(0.123, terms);
    EXPECT_LE(terms.size(), kind == Interpolation::fourier ? 25u : 4u);
    weights.termsAt(phases[7], terms);
    EXPECT_EQ(terms.size(), 1u);
  }
}

TEST(MotionInterpolation, PhasesOutOfOrderOrRangeAreRefused) {
  const auto linear = Interpolation::linear;
  EXPECT_EQ(says({}, linear), "scene.toml:3: motion: at least one keyframe is needed");
  EXPECT_EQ(says({0.0, 1.0}, linear),
            "scene.toml:3: motion: keyframe 2 has phase 1: phases from 0 to below 1 are accepted");
  EXPECT_EQ(
      says({-0.1}, linear),
      "scene.toml:3: motion: keyframe 1 has phase -0.1: phases from 0 to below 1 are accepted");
  EXPECT_EQ(says({0.5, 0.5}, linear),
            "scene.toml:3: motion: keyframe 2 has phase 0.5: phases must ascend by at least 1e-6");
  EXPECT_EQ(says({0.0, 0.9999999}, linear),
            "scene.toml:3: motion: keyframe 2 has phase 0.9999999: the first keyframe follows less "
            "than 1e-6 later");
  EXPECT_NE(says({std::nan("")}, linear), "no error");
}

TEST(MotionInterpolation, UnevenPhasesThatFourierWouldMagnifyAreRefused) {
  std::vector<double> bunched;
  for (int k = 0; k < 12; ++k) bunched.push_back(0.06 * k);
  const std::string error = says(bunched, Interpolation::fourier);
  EXPECT_NE(
      error.find(
          "at most 10 is accepted: space them evenly or use motion.interpolation = \"spline\""),
      std::string::npos)
      << error;
  EXPECT_EQ(says(bunched, Interpolation::spline), "no error");
  EXPECT_EQ(says(bunched, Interpolation::catmull_rom), "no error");
}

TEST(MotionInterpolation, SplineOverAVeryUnevenGapIsRefused) {
  EXPECT_NE(says({0.0, 1e-4, 0.5}, Interpolation::spline).find("motion.interpolation = \"linear\""),
            std::string::npos);
  EXPECT_EQ(says({0.0, 1e-4, 0.5}, Interpolation::linear), "no error");
}

TEST(MotionInterpolation, EvenKeyframesAreNeverMagnifiedMuch) {
  for (const Interpolation kind : kInterpolations)
    for (const std::size_t n : {2u, 3u, 8u, 25u, 30u, 100u}) {
      std::vector<double> phases(n);
      for (std::size_t k = 0; k < n; ++k)
        phases[k] = static_cast<double>(k) / static_cast<double>(n);
      EXPECT_LT(KeyframeWeights(phases, kind).magnification(), 4.0);
    }
}

}  // namespace
}  // namespace echocine::motion_test
