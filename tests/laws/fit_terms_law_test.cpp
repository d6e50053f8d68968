// How a model is laid on a loop and judged: closed forms, and changes that were planted.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "fit/descent.h"
#include "fit/dial_scan.h"
#include "fit/model_discrepancy.h"
#include "fit/tissue_greys.h"
#include "support/all_cases.h"
#include "support/drawn_heart.h"

namespace echocine::fit {

using namespace echo;
namespace {

using namespace support;

// One tissue's grey more than another's, and a gain linear over depth, are found exactly.
TEST(CompareFit, GreysOfTissuesAndGainAreFoundTogether) {
  TissueGreys greys({false, true, false});
  for (int i = 0; i < 300; ++i) {
    const int tissue = i % 3;
    const double depth = (i * 37 % 100) / 100.0;
    greys.add(tissue, tissue, 1, depth,
              std::array{80.0, 20.0, 140.0}[static_cast<std::size_t>(tissue)] + 60 * depth, 1);
  }
  const TissueGreys::Fit fit = greys.fit();
  EXPECT_NEAR(fit.ratio(), 0, 1e-6);
  EXPECT_NEAR(fit.grey[0] - fit.grey[1], 60, 1e-3);
  EXPECT_NEAR(fit.grey[2] - fit.grey[0], 60, 1e-3);
  EXPECT_NEAR(fit.gain[3] - fit.gain[0], 60, 1e-3);
}

// A cell that two tissues share has the grey between theirs.
TEST(CompareFit, SharedCellsCountByTheirShares) {
  TissueGreys greys({true, false});
  for (int i = 0; i < 200; ++i) {
    const double share = i % 11 / 10.0;
    greys.add(0, 1, share, i % 7 / 7.0, share * 10 + (1 - share) * 90, 1);
  }
  EXPECT_NEAR(greys.fit().ratio(), 0, 1e-6);
}

// Two tissues alone whose order a display cannot have are one: nothing is explained.
TEST(CompareFit, BloodIsNeverBrighter) {
  TissueGreys right({true, false}), wrong({false, true});
  for (int i = 0; i < 200; ++i)
    for (TissueGreys* greys : {&right, &wrong})
      greys->add(i % 2, i % 2, 1, i % 13 / 13.0, i % 2 == 0 ? 30 : 120, 1);
  EXPECT_NEAR(right.fit().ratio(), 0, 1e-6);
  EXPECT_NEAR(wrong.fit().ratio(), 1, 1e-6);
  // Also if the first blood of the model is not in the picture.
  TissueGreys unseen({true, true, false});
  for (int i = 0; i < 200; ++i)
    unseen.add(1 + i % 2, 1 + i % 2, 1, i % 13 / 13.0, i % 2 == 0 ? 120 : 30, 1);
  EXPECT_NEAR(unseen.fit().ratio(), 1, 1e-6);
}

// A bowl and a deeper one beside it: both bottoms are found, the deeper one first, and the limit is
// kept and told.
TEST(CompareFit, DescentsFindTheBottomsOfHills) {
  SearchBox box;
  box.high = {12, 12, 6, 0};
  box.low = {-12, -12, -6, 0};
  const auto bowl = [](const Unknowns& u, const Unknowns& at) {
    double square = 0;
    for (std::size_t i = 0; i < kUnknowns; ++i) square += (u[i] - at[i]) * (u[i] - at[i]);
    return square;
  };
  const Unknowns deep{-7.3, 2.1, 1.4, 0}, shallow{6.2, -3.7, -2.6, 0};
  const PoseFunction f = oneByOne([&](const Unknowns& u) {
    return 1 - 0.8 * std::exp(-bowl(u, deep) / 30) - 0.5 * std::exp(-bowl(u, shallow) / 30);
  });
  withThreads(2, [&] {
    const std::vector<Descent> hills =
        leastApart(descendAll(f, leastApart(lattice(f, box, {4, 4, 2, 2}), 5), box), 5);
    ASSERT_GE(hills.size(), 2u);
    for (std::size_t u = 0; u < kUnknowns; ++u) {
      EXPECT_NEAR(hills[0].at[u], deep[u], 0.02) << u;  // each pulls the other a little
      EXPECT_NEAR(hills[1].at[u], shallow[u], 0.05) << u;
    }
    EXPECT_FALSE(box.atLimit(hills[0].at));
    const Descent beyond = descend(oneByOne([&](const Unknowns& u) {
                                     return bowl(u, {20, 0, 0, 0});
                                   }),
                                   {}, box);
    EXPECT_EQ(beyond.at[0], 12);
    EXPECT_TRUE(box.atLimit(beyond.at));
  });
}

TEST(CompareFit, ConfidenceIsThePartOfTheWayByWhichTheBestWins) {
  EXPECT_NEAR(confidenceOf(0.2, 0.6, 0.8), 0.5, 1e-12);
  EXPECT_EQ(confidenceOf(0, 2, 0.8), 1);       // a rival worse than nothing is nothing
  EXPECT_EQ(confidenceOf(0.3, 0.3, 0.8), 0);   // as good elsewhere
  EXPECT_EQ(confidenceOf(0.9, 0.95, 0.8), 0);  // worse than nothing
  EXPECT_LT(confidenceOf(0.70, 0.75, 0.8), confidenceOf(0.20, 0.40, 0.8));
}

// The heart sinks into noise that moves with nothing. A pose that is told with confidence is right,
// and of noise alone none is.
TEST(CompareFit, APoseToldWithConfidenceIsRight) {
  const ModelLoop model = Phantom{}.model();
  const FitPose planted{0.012, -0.006, radiansFromDegrees(7), 1};
  constexpr double kConfident = 0.1;
  int confident = 0;
  withThreads(2, [&] {
    for (const double contrast : casesOf<double>({0.06, 0.0, 1.0, 0.5, 0.25, 0.12}, 2)) {
      EchoLoop real = draw(Phantom{}, planted, 20, 40);
      for (std::size_t n = 0; n < real.video.frames.size(); ++n)
        for (std::size_t i = 0; i < real.video.frames[n].size(); ++i) {
          std::uint8_t& grey = real.video.frames[n][i];
          const double noise = normalFromHashes(hashOf(n, i, 51), hashOf(n, i, 52));
          grey = static_cast<std::uint8_t>(
              std::clamp(128 + contrast * (grey - 128.0) + 40 * noise, 0.0, 255.0));
        }
      const PoseFound found = ModelDiscrepancy(real, fromTheStart(), model).search(model);
      const double apart_mm = 1e3 * std::hypot(found.pose.shift_x_m - planted.shift_x_m,
                                               found.pose.shift_z_m - planted.shift_z_m);
      std::printf("contrast %.2f: confidence %.3f, %.2f mm off, D %.3f\n", contrast,
                  found.confidence, apart_mm, found.discrepancy);
      if (found.confidence < kConfident) continue;
      EXPECT_GT(contrast, 0);
      ++confident;
      EXPECT_LT(apart_mm, 2) << contrast;
      EXPECT_NEAR(degreesFromRadians(found.pose.turn_rad - planted.turn_rad), 0, 2) << contrast;
    }
  });
  EXPECT_GE(confident, allCases() ? 2 : 1);
}

TEST(CompareFit, PlantedPosesAreFound) {
  const ModelLoop model = Phantom{}.model();
  std::uint64_t seed = 5;
  for (const FitPose planted : casesOf<FitPose>(
           {{0.011, -0.007, radiansFromDegrees(6), 1}, {-0.018, 0.009, radiansFromDegrees(-11), 1}},
           1)) {
    withThreads(2, [&] {
      const ModelDiscrepancy d(draw(Phantom{}, planted, 20, ++seed), fromTheStart(), model);
      const PoseFound found = d.search(model);
      EXPECT_NEAR(found.pose.shift_x_m, planted.shift_x_m, 1e-3);
      EXPECT_NEAR(found.pose.shift_z_m, planted.shift_z_m, 1e-3);
      EXPECT_NEAR(degreesFromRadians(found.pose.turn_rad - planted.turn_rad), 0, 2);
      EXPECT_FALSE(found.at_limit);
      EXPECT_GT(found.confidence, 0.3);
      std::printf("planted %.1f, %.1f mm, %.1f deg found %.2f, %.2f mm, %.2f deg, D %.3f\n",
                  1e3 * planted.shift_x_m, 1e3 * planted.shift_z_m,
                  degreesFromRadians(planted.turn_rad), 1e3 * found.pose.shift_x_m,
                  1e3 * found.pose.shift_z_m, degreesFromRadians(found.pose.turn_rad),
                  found.discrepancy);
    });
  }
}

// Of a loop that has no scale of its own.
TEST(CompareFit, APlantedScaleIsFound) {
  const ModelLoop model = Phantom{}.model();
  const FitPose planted{0.006, 0.004, radiansFromDegrees(4), 1.06};
  EchoLoop real = draw(Phantom{}, planted, 20, 9);
  FitSettings settings;
  settings.limits.scale_free = true;
  withThreads(2, [&] {
    const ModelDiscrepancy d(real, fromTheStart(), model, settings);
    const PoseFound found = d.search(model);
    EXPECT_NEAR(found.pose.scale, planted.scale, 0.02 * planted.scale);
    EXPECT_NEAR(found.pose.shift_x_m, planted.shift_x_m, 1e-3);
    EXPECT_NEAR(found.pose.shift_z_m, planted.shift_z_m, 1e-3);
  });
}

// A loop that starts anywhere in its beat: the model tells where.
TEST(CompareFit, TheStartOfTheBeatIsFound) {
  const ModelLoop model = Phantom{}.model();
  withThreads(2, [&] {
    const ModelDiscrepancy d(draw(Phantom{}, {}, 20, 3, 0.35), {}, model);
    EXPECT_NEAR(d.beat().span.end_diastole, 13, 0.8);  // of 20 frames: phase 1 - 0.35
    EXPECT_GT(d.beat().confidence, 0.2);
  });
}

// Without motion every start is as good.
TEST(CompareFit, AStillLoopTellsNoStart) {
  const ModelLoop model = Phantom{.grow_m = 0, .beat = 0}.model();
  withThreads(2, [&] {
    const ModelDiscrepancy d(draw(Phantom{.grow_m = 0, .beat = 0}, {}, 20, 3), {}, model);
    EXPECT_LT(d.beat().confidence, 0.2);
  });
}

// Another size or another beat is a worse model in its own term.
TEST(CompareFit, TermsSeeSizeAndMotion) {
  withThreads(2, [&] {
    const ModelLoop right = Phantom{}.model();
    const ModelDiscrepancy d(draw(Phantom{}, {}, 20, 21), fromTheStart(), right);
    const PoseFound best = d.at(right, {});
    const PoseFound larger = d.at(Phantom{.grow_m = 0.003, .beat = 0.15}.model(), {});
    const PoseFound still = d.at(Phantom{.grow_m = 0, .beat = 0}.model(), {});
    EXPECT_LT(best.terms.region, larger.terms.region - 0.02);
    EXPECT_LT(best.terms.boundary, larger.terms.boundary - 0.02);
    EXPECT_LT(best.terms.motion, still.terms.motion - 0.1);
    EXPECT_LT(best.discrepancy, larger.discrepancy);
    EXPECT_LT(best.discrepancy, still.discrepancy);
    EXPECT_GT(best.terms.overlap, 0.95);
    // Where the model is 3 mm too large its edges are seen inside.
    double offset = 0, weight = 0;
    for (const auto& frame : d.map(Phantom{.grow_m = 0.003, .beat = 0.15}.model(), {}).boundary)
      for (const BoundaryOffset& p : frame)
        offset += static_cast<double>(p.certainty * p.offset_mm),
            weight += static_cast<double>(p.certainty);
    EXPECT_LT(offset / weight, -1);
    EXPECT_GT(offset / weight, -4);
  });
}

// Small changes of a model are small changes of D: it bends evenly, step by tenth of a millimetre.
TEST(CompareFit, DiscrepancyIsSmoothInTheModel) {
  withThreads(2, [&] {
    const ModelDiscrepancy d(draw(Phantom{}, {}, 20, 33), fromTheStart(), Phantom{}.model());
    std::vector<double> values;
    for (int i = 0; i < 9; ++i)
      values.push_back(
          d.refine(Phantom{.grow_m = 1e-4 * i, .beat = 0.15}.model(), {{}}).discrepancy);
    for (std::size_t i = 1; i + 1 < values.size(); ++i)
      EXPECT_LT(std::abs(values[i - 1] - 2 * values[i] + values[i + 1]), 0.002);
    EXPECT_GT(values.back(), values.front());
  });
}

// A mean of the terms: where all are alike it is what each is, whatever their weights.
TEST(CompareFit, DiscrepancyIsAMeanOfItsTerms) {
  FitTerms terms;
  terms.overlap = 1;
  terms.region = terms.boundary = terms.motion = 0.6;
  EXPECT_NEAR(fitDiscrepancy(terms), 0.6, 1e-12);
  EXPECT_NEAR(fitDiscrepancy(terms, {.region = 1, .boundary = 2, .motion = 5}), 0.6, 1e-12);
  terms.overlap = 0.5;  // what is out of sight is unrelated
  EXPECT_NEAR(fitDiscrepancy(terms), 0.8, 1e-12);
}

TEST(CompareFit, LessThanHalfABeatIsRefused) {
  EchoLoop loop = draw(Phantom{}, {}, 8, 1);
  loop.frames_per_beat = 20;
  EXPECT_THROW(ModelDiscrepancy(loop, fromTheStart(), Phantom{}.model()), SceneError);
}

// Between the nodes as at them, a family's heart is the one that is computed there: its blood has
// the same area in the plane, in m2 up to a constant. A family keeps the first node's sector, whose
// depth is the unit of the cells' areas.
TEST(CompareFit, AFamilyHoldsItsHearts) {
  withThreads(2, [&] {
    const auto areaOf = [](const HeartFamily& family, double ef, std::size_t frame) {
      const ModelLoop loop = family.at({ef});
      return bloodOf(loop, frame) * loop.far_m * loop.far_m;
    };
    const HeartNodes three({}, {{"ef", 0.4, 0.6}}, 4, 3), two({}, {{"ef", 0.44, 0.57}}, 4, 2);
    for (const heart::View view : {heart::View::a4c, heart::View::psax_mid}) {
      const HeartFamily family(three, view), computed(two, view);  // both at nodes
      for (const double ef : {0.44, 0.57})
        for (std::size_t frame = 0; frame < 4; ++frame) {
          const double wanted = areaOf(computed, ef, frame);
          EXPECT_NEAR(areaOf(family, ef, frame), wanted, 2e-3 * wanted) << ef << ' ' << frame;
        }
      // Quarter of a beat: the ventricle is emptier the more it ejects.
      EXPECT_GT(areaOf(family, 0.4, 1), areaOf(family, 0.5, 1));
      EXPECT_GT(areaOf(family, 0.5, 1), areaOf(family, 0.6, 1));
      EXPECT_FALSE(family.at({0.5}).frames[1].boundary.empty());
    }
  });
}

}  // namespace
}  // namespace echocine::fit
