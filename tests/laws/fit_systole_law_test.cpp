// Hearts of other shares of systole are held against each other's beat at their own end-systole.

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "fit/model_discrepancy.h"
#include "support/all_cases.h"
#include "support/drawn_heart.h"

namespace echocine::fit {

using namespace echo;
namespace {

using namespace support;

ModelLoop timed(const Phantom& phantom = {}) {
  ModelLoop model = phantom.model();
  model.systole = 0.5;
  return model;
}

// Ends and end-systole are kept, both parts run evenly, and there and back is nothing.
TEST(CompareSystole, AWarpKeepsEndDiastoleAndMeetsEndSystole) {
  for (const double to : {0.2, 0.35, 0.6}) {
    EXPECT_EQ(warpedPhase(0, 0.35, to), 0);
    EXPECT_NEAR(warpedPhase(0.35, 0.35, to), to, 1e-12);
    EXPECT_NEAR(warpedPhase(1, 0.35, to), 1, 1e-12);
    EXPECT_NEAR(warpedPhase(0.175, 0.35, to), to / 2, 1e-12);
    EXPECT_NEAR(warpedPhase(0.675, 0.35, to), (1 + to) / 2, 1e-12);
    for (double phase = -1; phase < 2; phase += 0.07)
      EXPECT_NEAR(warpedPhase(warpedPhase(phase, 0.35, to), to, 0.35), phase, 1e-12);
  }
  EXPECT_EQ(warpedPhase(0.4, 0, 0.3), 0.4);
}

// End-systole is found where it was planted, with confidence, and a model whose systole has another
// share of the beat does not pay for it.
TEST(CompareSystole, ThePlantedEndSystoleIsFound) {
  withThreads(2, [] {
    const ModelLoop model = timed();
    const auto held = [&](const EchoLoop& loop) {
      return ModelDiscrepancy(loop, fromTheStart(), model);
    };
    const double even = held(draw(Phantom{}, {}, 20, 3)).search(model).discrepancy;
    for (const double planted : casesOf<double>({0.33, 0.61, 0.42, 0.5}, 2)) {
      const EchoLoop loop = draw(Phantom{}, {}, 20, 3, 0, planted);
      const ModelDiscrepancy d = held(loop);
      const double warped = d.search(model).discrepancy,
                   stiff = ModelDiscrepancy(loop, fromTheStart(), Phantom{}.model())
                               .search(Phantom{}.model())
                               .discrepancy;
      std::printf(
          "end-systole planted at %.2f, found at %.3f, confidence %.2f; D %.3f, without %.3f, "
          "of an even beat %.3f\n",
          planted, d.beat().span.systole, d.beat().systole_confidence, warped, stiff, even);
      EXPECT_NEAR(d.beat().span.systole, planted, 0.05);  // a picture
      EXPECT_GT(d.beat().systole_confidence, 0.1);
      EXPECT_NEAR(warped, even, 0.03);
      if (std::abs(planted - 0.5) > 0.1) {
        EXPECT_LT(warped, stiff - 0.03);
      }
    }
  });
}

// Without motion every end-systole is as good.
TEST(CompareSystole, AStillLoopTellsNone) {
  withThreads(2, [] {
    const Phantom still{.grow_m = 0, .beat = 0};
    const EchoLoop loop = draw(still, {}, 20, 3);
    const BeatFound beat = ModelDiscrepancy(loop, fromTheStart(), timed(still)).beat();
    std::printf("still: confidence %.3f\n", beat.systole_confidence);
    EXPECT_LT(beat.systole_confidence, 0.1);
  });
}

TEST(CompareSystole, AGivenEndSystoleIsTaken) {
  withThreads(2, [] {
    SideOptions side = fromTheStart();
    side.es_frame = 7;
    const ModelLoop model = timed();
    const ModelDiscrepancy d(draw(Phantom{}, {}, 20, 3, 0, 0.35), side, model);
    EXPECT_NEAR(d.beat().span.systole, 0.35, 1e-12);
    EXPECT_EQ(d.beat().systole_confidence, 1);
    side.es_frame = 18;
    // The text names no option: callers have different ones.
    try {
      const ModelDiscrepancy refused(draw(Phantom{}, {}, 20, 3), side, model);
      ADD_FAILURE();
    } catch (const SceneError& error) {
      const std::string text = error.what();
      EXPECT_EQ(text.rfind("end-systole: frame 18", 0), 0u) << text;
      EXPECT_EQ(text.find("--"), std::string::npos) << text;
    }
  });
}

}  // namespace
}  // namespace echocine::fit
