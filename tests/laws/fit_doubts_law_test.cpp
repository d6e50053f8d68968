// Each reason to doubt a fit is one line, and a fit without one has none.

#include <gtest/gtest.h>

#include "core/error.h"
#include "fit/caveats.h"
#include "fit/fit_doubts.h"
#include "fit/fit_files.h"
#include "fit/fit_page.h"
#include "fit/fit_progress.h"
#include "support/drawn_heart.h"

namespace echocine::fit {
namespace {

using namespace support;

// Nothing to doubt.
HeartFit soundFit() {
  HeartFit fit;
  fit.found = {{"ef", 0.5, 0.02, 0.1, false, true},
               {"mapse", 12, 1, 3, false, true},
               {"edv", 130, 8, 40, false, true}};
  fit.ef = Estimate{0.5, 0.45, 0.55};
  fit.edv_ml = Estimate{130, 110, 150};
  ViewFitted view;
  view.view = heart::View::a4c;
  view.found.discrepancy = 0.3;
  view.found.terms.overlap = 0.9;
  view.controls = ControlFits{0.3, 0.5, 0.4};
  fit.views = {view};
  fit.rivals = {{{}, 0.3, 130, {}, 10}};
  return fit;
}

TEST(FitDoubts, ASoundFitHasNone) {
  HeartFit fit = soundFit();
  EXPECT_EQ(refusalOf(fit), "");
  addHints(fit);
  EXPECT_TRUE(fit.hints.empty());
}

TEST(FitDoubts, EachReasonRefuses) {
  const auto refused = [](auto plant) {
    HeartFit fit = soundFit();
    plant(fit);
    const std::string text = refusalOf(fit);
    EXPECT_EQ(text.find('\n'), std::string::npos);
    return text;
  };
  EXPECT_NE(refused([](HeartFit& f) { f.views[0].found.discrepancy = 0.95; }).find("no heart"),
            std::string::npos);
  EXPECT_NE(refused([](HeartFit& f) { f.views[0].controls->mirrored = 0.301; }).find("mirror"),
            std::string::npos);
  EXPECT_NE(refused([](HeartFit& f) { f.views[0].controls->shuffled = 0.2; }).find("shuffled"),
            std::string::npos);
  EXPECT_NE(refused([](HeartFit& f) { f.found[0].determined = false; }).find("another view"),
            std::string::npos);
  EXPECT_NE(refused([](HeartFit& f) {
              f.views[0].controls->mirrored = 0.2;
              f.views[0].beat.length_source = kLoopIsBeat;
            }).find("give a loop of a whole beat"),
            std::string::npos);
  // A control clearly worse, another dial that the loops do not tell, and a stopped fit: no reason.
  EXPECT_EQ(refused([](HeartFit& f) { f.views[0].controls->mirrored = 0.303; }), "");
  EXPECT_EQ(refused([](HeartFit& f) { f.found[1].determined = false; }), "");
  EXPECT_EQ(refused([](HeartFit& f) { f.views[0].controls.reset(); }), "");
}

TEST(FitDoubts, EachDoubtIsOneHint) {
  const auto hinted = [](auto plant) {
    HeartFit fit = soundFit();
    plant(fit);
    addHints(fit);
    EXPECT_EQ(fit.hints.size(), 1u);
    return fit.hints.empty() ? "" : fit.hints.front();
  };
  EXPECT_NE(hinted([](HeartFit& f) { f.found[1].at_limit = true; }).find("mapse is at its limit"),
            std::string::npos);
  EXPECT_NE(
      hinted([](HeartFit& f) { f.found[1].determined = false; }).find("mapse is not determined"),
      std::string::npos);
  EXPECT_NE(hinted([](HeartFit& f) { f.views[0].beat.confidence = 0.05; }).find("--ed"),
            std::string::npos);
  EXPECT_NE(hinted([](HeartFit& f) {
              f.views[0].beat.length_source = kLoopIsBeat;
            }).find("does not close"),
            std::string::npos);
  EXPECT_NE(hinted([](HeartFit& f) { f.views[0].found.terms.overlap = 0.5; }).find("only 50 %"),
            std::string::npos);
  EXPECT_NE(hinted([](HeartFit& f) {
              f.views[0].better = ViewRival{heart::View::a2c, 0.7, 0.6};
            }).find("the heart in a2c explains"),
            std::string::npos);
  EXPECT_NE(hinted([](HeartFit& f) { f.views[0].found.at_limit = true; }).find("--scale"),
            std::string::npos);
  EXPECT_NE(hinted([](HeartFit& f) { f.views[0].scaled = false; }).find("--scale"),
            std::string::npos);
  EXPECT_NE(hinted([](HeartFit& f) { f.found.pop_back(); }).find("edv is not searched: 130 mL is"),
            std::string::npos);
  EXPECT_NE(hinted([](HeartFit& f) {
              f.found.erase(f.found.begin());
            }).find("ef is not searched: 0.5 is"),
            std::string::npos);
  EXPECT_NE(hinted([](HeartFit& f) { f.rivals[0].cost_above = 2; }).find("EF 0.30"),
            std::string::npos);
}

// The own offset of a structure and frame is subtracted at each of its points; others stay.
TEST(FitDoubts, OwnOffsetsAreSubtracted) {
  const auto point = [](float offset_mm, std::uint16_t surface) {
    BoundaryOffset p;
    p.offset_mm = offset_mm;
    p.certainty = 1;
    p.surface = surface;
    return p;
  };
  FitReport own;
  own.structures = {"lv_wall", "rv_wall"};
  own.map.boundary = {{point(-3, 0), point(-1, 0)}, {point(1, 0)}};
  FitMap map;
  map.boundary = {{point(-2, 0), point(5, 0), point(1, 1)}, {point(1, 0)}};
  const FitMap beyond = beyondOwn(map, own);
  EXPECT_FLOAT_EQ(beyond.boundary[0][0].offset_mm, 0);
  EXPECT_FLOAT_EQ(beyond.boundary[0][1].offset_mm, 7);
  EXPECT_FLOAT_EQ(beyond.boundary[0][2].offset_mm, 1);
  EXPECT_FLOAT_EQ(beyond.boundary[1][0].offset_mm, 0);
}

ViewRanking rankingOf(double confidence) {
  ViewRanking ranking;
  ranking.views.resize(2);
  ranking.views[0].view = heart::View::a2c;
  ranking.confidence = confidence;
  return ranking;
}

TEST(FitDoubts, AnUnclearViewIsRefusedWithItsName) {
  EXPECT_EQ(clearView("two.mp4", rankingOf(kLeastConfidence)), heart::View::a2c);
  try {
    clearView("two.mp4", rankingOf(0.05));
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_STREQ(error.what(),
                 "two.mp4: the view is unclear: a2c with a confidence of 0.05, accepted: 0.1 or "
                 "more; name it, such as a2c=FILE");
  }
}

// The counter of a fit never falls, whatever its stages tell, and ends at its total.
TEST(FitProgress, OneCounterForAllStages) {
  std::vector<std::size_t> told;
  Monitor monitor;
  monitor.tell = [&](const Progress& p) {
    EXPECT_EQ(p.total, 100u);
    told.push_back(p.done);
  };
  FitProgress progress(monitor, 100);
  Monitor first = progress.next(40), second = progress.next(60);
  first.tell({Task::hearts, 1, 2});
  first.tell({Task::hearts, 5, 2});
  first.tell({Task::hearts, 1, 2});  // a part that begins anew
  second.tell({Task::settings, 0, 0});
  second.tell({Task::settings, 3, 6});
  progress.finish();
  EXPECT_EQ(told, (std::vector<std::size_t>{20, 40, 40, 40, 70, 100}));
}

EchoLoop drawnBeat() {
  return beatOnly(draw(Phantom{}, {}, 31, 3), {.end_diastole = 4, .frames = 31});
}

TEST(FitControls, TheBeatBeginsAtEndDiastole) {
  const EchoLoop loop = draw(Phantom{}, {}, 31, 3);
  const EchoLoop beat = drawnBeat();
  ASSERT_EQ(beat.video.frames.size(), static_cast<std::size_t>(kFitFrames));
  EXPECT_EQ(beat.video.frames.front(), loop.video.frames[4]);
  EXPECT_EQ(beat.video.frames.back(),
            loop.video.frames[2]);  // 4 + 0.95 x 31 = 33.45, a beat earlier
}

TEST(FitControls, AMirroredLoopMirroredIsTheLoop) {
  const EchoLoop beat = drawnBeat(), once = mirrored(beat), twice = mirrored(once);
  EXPECT_NE(once.video.frames, beat.video.frames);
  EXPECT_EQ(twice.video.frames, beat.video.frames);
  EXPECT_EQ(twice.overlay, beat.overlay);
  EXPECT_EQ(twice.sector().apex_x, beat.sector().apex_x);
  EXPECT_EQ(twice.sector().first_rad, beat.sector().first_rad);
  // Pixel and sector agree: the same places are inside.
  for (int x = 0; x < beat.video.width; ++x)
    EXPECT_EQ(beat.sector().contains(x + 0.5, 0.5 * beat.video.height),
              once.sector().contains(beat.video.width - x - 0.5, 0.5 * beat.video.height));
}

TEST(FitControls, AShuffledLoopHasTheSamePictures) {
  const EchoLoop beat = drawnBeat(), other = shuffled(beat);
  EXPECT_NE(other.video.frames, beat.video.frames);
  EXPECT_TRUE(std::is_permutation(other.video.frames.begin(), other.video.frames.end(),
                                  beat.video.frames.begin()));
}

// The right heart fits its loop better than both controls. A still fits its shuffled pictures as
// well, a flipped loop its mirror image better.
TEST(FitControls, TheLoopItselfFitsBest) {
  const ModelLoop heart = Phantom{}.model();
  const auto controls = [&](const EchoLoop& loop) {
    return controlFits(loop, {.end_diastole = 0, .frames = 20}, heart, {});
  };
  const EchoLoop loop = draw(Phantom{}, {}, 20, 3);
  const ControlFits right = controls(loop);
  EXPECT_GT(right.mirrored, 1.1 * right.own);
  EXPECT_GT(right.shuffled, 1.1 * right.own);
  EchoLoop still = loop;
  for (auto& frame : still.video.frames) frame = loop.video.frames.front();
  const ControlFits frozen = controls(still);
  EXPECT_NEAR(frozen.shuffled, frozen.own, 1e-6);
  const ControlFits flipped = controls(mirrored(loop));
  EXPECT_LT(flipped.mirrored, flipped.own);
}

}  // namespace
}  // namespace echocine::fit
