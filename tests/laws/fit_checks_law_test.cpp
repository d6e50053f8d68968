// Requests of an optimiser for hearts and poses: those out of range are refused in one line that
// names the argument.

#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "fit/dial_checks.h"
#include "fit/heart_family.h"
#include "fit/model_discrepancy.h"
#include "support/drawn_heart.h"

namespace echocine::fit {
namespace {

using namespace support;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(),
                 kInfinite = std::numeric_limits<double>::infinity();

void expectRefused(const std::function<void()>& call, const std::string& begins) {
  try {
    call();
    ADD_FAILURE() << "accepted, expected: " << begins;
  } catch (const SceneError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find(begins), 0u) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST(FitChecksLaw, FamiliesThatCannotBeAreRefused) {
  const auto family = [](const std::map<std::string, double>& dials,
                         const std::vector<DialRange>& ranges,
                         int nodes) { return [=] { HeartNodes(dials, ranges, 4, nodes); }; };
  expectRefused(family({}, {{"eff", 0.4, 0.6}}, 2), "ranges: \"eff\" is not a dial");
  expectRefused(family({}, {{"ef", 0.6, 0.4}}, 2), "ranges: ef is 0.6 to 0.4");
  expectRefused(family({}, {{"ef", 0.4, 0.4}}, 2), "ranges: ef is 0.4 to 0.4");
  expectRefused(family({}, {{"ef", 0.4, kNaN}}, 2), "ranges: ef is nan");
  expectRefused(family({}, {{"ef", -kInfinite, 0.4}}, 2), "ranges: ef is -inf");
  expectRefused(family({}, {{"ef", 0.4, 0.5}, {"ef", 0.4, 0.5}}, 2), "ranges: ef is given twice");
  expectRefused(family({{"ef", 0.5}}, {{"ef", 0.4, 0.6}}, 2), "dials: ef has a range");
  expectRefused(family({{"hr", kNaN}}, {}, 2), "dials: hr is nan");
  // Two dials of one volume, each given or with a range.
  expectRefused(family({{"rv-edv", 130}, {"rv-ratio", 1}}, {}, 2), "dials: rv-edv and rv-ratio");
  expectRefused(family({{"rv-edv", 130}}, {{"rv-ratio", 1, 1.2}}, 2), "dials: rv-edv and rv-ratio");
  expectRefused(family({{"rv-ratio", 1}}, {{"rv-edv", 130, 140}}, 2), "dials: rv-edv and rv-ratio");
  expectRefused(family({}, {{"ef", 0.4, 0.6}}, 1), "nodes: is 1");
  expectRefused(family({}, {{"ef", 0.4, 0.6}}, 10), "nodes: is 10");
  expectRefused(family({}, {{"ef", 0.4, 0.6}, {"edv", 90, 120}, {"hr", 60, 80}}, 6), "nodes: 6");
}

TEST(FitChecksLaw, HeartsOutsideTheirFamilyAreRefused) {
  withThreads(2, [] {
    const HeartNodes nodes({{"hr", 72}}, {{"ef", 0.45, 0.55}}, 4, 2);
    const HeartFamily family(nodes, heart::View::a4c, {}, 1);
    EXPECT_EQ(family.at({0.45}).frames.size(), 4u);
    EXPECT_EQ(family.at({0.55 + 1e-13}).frames.size(), 4u);  // a sum of steps
    for (const double ef : {0.44, 0.56, kNaN, kInfinite})
      expectRefused([&] { family.at({ef}); }, "values: ef is");
    expectRefused([&] { family.at({}); }, "values: holds 0 numbers, accepted: 1");
    expectRefused([&] { family.at({0.5, 0.5}); }, "values: holds 2");
    expectRefused([&] { family.at({0.5}, {.tilt_rad = 0.02, .rotate_rad = 0}); }, "tilt_deg: is");
    expectRefused([&] { family.at({0.5}, {.tilt_rad = 0, .rotate_rad = kNaN}); }, "rotate_deg: is");
    for (const double most_deg : {-1.0, 20.5, kNaN})
      expectRefused([&] { HeartFamily(nodes, heart::View::a4c, {}, most_deg); }, "tilt_deg: is");
  });
}

TEST(FitChecksLaw, PosesTogetherHaveTheTermsOfEach) {
  withThreads(2, [] {
    const ModelLoop model = Phantom{}.model();
    const ModelDiscrepancy d(draw(Phantom{}, {}, 20, 21), fromTheStart(), model);
    std::vector<FitPose> poses(19);  // no multiple of what is taken together
    for (std::size_t i = 0; i < poses.size(); ++i) {
      poses[i].shift_x_m = 1e-3 * static_cast<double>(i);
      poses[i].lag = static_cast<int>(i) - 9;
    }
    const std::vector<FitTerms> together = d.terms(model, poses);
    ASSERT_EQ(together.size(), poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const PoseFound one = d.at(model, poses[i]);
      EXPECT_EQ(fitDiscrepancy(together[i]), one.discrepancy);
      EXPECT_EQ(together[i].motion, one.terms.motion);
      EXPECT_EQ(together[i].overlap, one.terms.overlap);
    }
  });
}

TEST(FitChecksLaw, PosesAndWeightsThatMeanNothingAreRefused) {
  withThreads(2, [] {
    const ModelLoop model = Phantom{}.model();
    const echo::EchoLoop real = draw(Phantom{}, {}, 20, 21);
    const ModelDiscrepancy d(real, fromTheStart(), model);
    expectRefused([&] { d.at(model, {.shift_x_m = kNaN}); }, "pose: shift_x_mm is nan");
    expectRefused([&] { d.at(model, {.shift_z_m = 0.6}); }, "pose: shift_z_mm is 600");
    expectRefused([&] { d.at(model, {.turn_rad = 4}); }, "pose: turn_deg is 229");
    expectRefused([&] { d.at(model, {.scale = 0}); }, "pose: scale is 0");
    expectRefused([&] { d.at(model, {.lag = 1001}); }, "pose: lag is 1001");
    expectRefused([&] { d.at(model, {.systole = 1}); }, "pose: systole is 1");
    expectRefused([&] { d.terms(model, {{}, {.scale = kInfinite}}); }, "pose: scale is inf");
    expectRefused([&] { d.refine(model, {}); }, "starts: contains no pose");
    expectRefused([&] { d.refine(model, {{.scale = -1}}); }, "pose: scale is -1");
    for (const FitWeights weights :
         {FitWeights{0, 0, 0}, FitWeights{-1, 2, 2}, FitWeights{kNaN, 1, 1}, {kInfinite, 1, 1}})
      expectRefused(
          [&] {
            ModelDiscrepancy(real, fromTheStart(), model, {.weights = weights, .limits = {}});
          },
          "weights: is");
  });
}

}  // namespace
}  // namespace echocine::fit
