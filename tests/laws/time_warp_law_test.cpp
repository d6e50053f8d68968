// Keyframes of one heart rate at another.

#include "motion/cycle/time_warp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "motion/cycle/volume_curve.h"

namespace echocine {
namespace {

constexpr double kKeyframes_bpm[] = {35, 50, 65, 75, 100, 120, 180, 220};

RecordedBeat recordedAt(double bpm, std::optional<double> end_systole = {}) {
  return {bpm / 60, end_systole};
}

double endSystolePhase(const RecordedBeat& r) {
  return r.end_systole_phase.value_or(cycleEvents(phaseDurations(r.heart_rate_hz)).aortic_closes);
}

// All pairs of rates, with and without an end-systole of the keyframes' own.
void forEachPair(const std::function<void(const RecordedBeat&, double beat_s)>& visit) {
  for (const double keyframes : kKeyframes_bpm)
    for (double bpm = 30; bpm <= 220; bpm += 2.5)
      for (const std::optional<double>& anchor :
           {std::optional<double>(), std::optional(0.25), std::optional(0.4), std::optional(0.6)})
        visit(recordedAt(keyframes, anchor), 60 / bpm);
}

// When the keyframes' phase reaches a value.
double timeOf(const TimeWarp& warp, double beat_s, double phase) {
  double lo = 0, hi = beat_s;
  for (int i = 0; i < 60; ++i) (warp.phaseAt((lo + hi) / 2) < phase ? lo : hi) = (lo + hi) / 2;
  return lo;
}

// A warp maps the beat onto itself and never runs backwards.
TEST(TimeWarp, RunsThroughTheWholeBeatForwardAtEveryRate) {
  forEachPair([](const RecordedBeat& recorded, double beat_s) {
    const TimeWarp warp(recorded, beat_s);
    ASSERT_EQ(warp.phaseAt(0), 0);
    ASSERT_NEAR(warp.phaseAt(beat_s), 1, 1e-15);
    constexpr int kSteps = 400;
    double before = 0;
    for (int i = 1; i <= kSteps; ++i) {
      const double now = warp.phaseAt(beat_s * i / kSteps);
      ASSERT_GT(now, before) << recorded.heart_rate_hz << ' ' << beat_s << ' ' << i;
      // No leap: at most where 1.2 s of diastasis has to pass in a beat of 0.4 s.
      ASSERT_LT(now - before, (recorded.end_systole_phase ? 21.0 : 12.0) / kSteps);
      before = now;
    }
  });
}

// All that a scene may ask for.
TEST(TimeWarp, RunsForwardAlsoAtTheEndsOfWhatIsAccepted) {
  for (const double keyframes : {1.0, 30.0, 220.0, 1000.0})
    for (const double bpm : {0.8, 1.0, 30.0, 220.0, 1000.0, 10000.0})
      for (const double anchor : {0.1, 0.8}) {
        const TimeWarp warp(recordedAt(keyframes, anchor), 60 / bpm);
        double before = 0;
        for (int i = 1; i <= 4000; ++i) {
          const double now = warp.phaseAt(60 / bpm * i / 4000);
          ASSERT_GE(now, before) << keyframes << ' ' << bpm << ' ' << anchor << ' ' << i;
          before = now;
        }
        ASSERT_NEAR(before, 1, 1e-12);
      }
}

// A kink is a jump of all velocities at once, which strain shows.
TEST(TimeWarp, HasNoKink) {
  forEachPair([](const RecordedBeat& recorded, double beat_s) {
    const TimeWarp warp(recorded, beat_s);
    constexpr int kSteps = 2000;
    constexpr double kStep = 1e-7;
    const auto slope = [&](double t) {
      return (warp.phaseAt(t + kStep) - warp.phaseAt(t - kStep)) / (2 * kStep);
    };
    // Where slopes differ between neighbours, they differ less over a hundredth of the way.
    for (int i = 1; i < kSteps; ++i) {
      const double t = beat_s * i / kSteps, width = beat_s / kSteps;
      const double far = std::abs(slope(t + 0.4 * width) - slope(t - 0.4 * width));
      if (far < 0.05) continue;
      ASSERT_LT(std::abs(slope(t + 0.004 * width) - slope(t - 0.004 * width)), 0.25 * far + 0.02)
          << recorded.heart_rate_hz << ' ' << beat_s << ' ' << i;
    }
  });
}

// To the last bit: loops at the recorded rate must not change because warping exists.
TEST(TimeWarp, IsTheIdentityAtTheKeyframesOwnRate) {
  for (const double bpm : kKeyframes_bpm)
    for (const std::optional<double>& anchor : {std::optional<double>(), std::optional(0.45)}) {
      const double beat_s = 60 / bpm;
      const TimeWarp warp(recordedAt(bpm, anchor), beat_s);
      for (int i = 0; i <= 1000; ++i)
        ASSERT_NEAR(warp.phaseAt(beat_s * i / 1000), i / 1000.0, 1e-13);
    }
}

TEST(TimeWarp, SystoleLastsWhatIsPublishedForThePlayedRate) {
  for (const double keyframes : kKeyframes_bpm)
    for (double bpm = 30; bpm <= 220; bpm += 1) {
      const RecordedBeat recorded = recordedAt(keyframes);
      const TimeWarp warp(recorded, 60 / bpm);
      const double published = phaseDurations(bpm / 60).endSystole();
      EXPECT_NEAR(timeOf(warp, 60 / bpm, endSystolePhase(recorded)), published, 0.005);
      EXPECT_NEAR(warp.endSystole(), published, 1e-12);
    }
}

TEST(TimeWarp, EndSystoleOfTheKeyframesOwnIsWhereThePlayedSystoleEnds) {
  forEachPair([](const RecordedBeat& recorded, double beat_s) {
    const TimeWarp warp(recorded, beat_s);
    ASSERT_NEAR(timeOf(warp, beat_s, endSystolePhase(recorded)), warp.endSystole(), 1e-9);
    ASSERT_LT(warp.endSystole(), 0.95 * beat_s);
  });
}

// Of any change of the beat, up to 120 bpm; from 147 on systole gives the larger half of it on the
// exercise line, since little of diastole is left.
TEST(TimeWarp, DiastoleGivesMoreThanSystole) {
  for (const double keyframes : {35.0, 50.0, 65.0, 75.0, 100.0, 120.0})
    for (double bpm = 30; bpm <= 120; bpm += 2.5) {
      if (std::abs(bpm - keyframes) < 1) continue;
      const RecordedBeat recorded = recordedAt(keyframes);
      const double beat_s = 60 / bpm, recorded_s = 60 / keyframes;
      const double systole = timeOf(TimeWarp(recorded, beat_s), beat_s, endSystolePhase(recorded));
      const double of_systole = std::abs(systole - endSystolePhase(recorded) * recorded_s);
      const double of_diastole = std::abs(beat_s - recorded_s) - of_systole;
      EXPECT_GT(of_diastole, of_systole) << keyframes << ' ' << bpm;
    }
}

// A ventricle recorded at one rate has the ejection time of the other when it is played there.
TEST(TimeWarp, AVolumeCurveEjectsForThePublishedTime) {
  for (const double keyframes : {50.0, 65.0, 100.0})
    for (const double bpm : {40.0, 65.0, 90.0, 120.0, 160.0}) {
      const VolumeCurve curve(phaseDurations(keyframes / 60));
      const TimeWarp warp(recordedAt(keyframes), 60 / bpm);
      double opens = 0, closes = 0;
      for (double t = 0; t < 60 / bpm; t += 1e-5) {
        const double volume = curve.at(warp.phaseAt(t));
        if (opens == 0 && volume < 1 - 1e-8) opens = t;
        if (closes == 0 && volume < 1e-8) closes = t;
      }
      EXPECT_NEAR(closes - opens, phaseDurations(bpm / 60).ejection_s, 0.005)
          << keyframes << ' ' << bpm;
    }
}

// Slope 1 at the R wave on both sides: beats of different lengths join without a jump of speed.
TEST(TimeWarp, KeyframesRunInRealTimeAtTheRWaveSoThatBeatsOfAnyLengthJoin) {
  for (const double keyframes : {50.0, 65.0, 75.0, 100.0})
    for (double bpm = 40; bpm <= 140; bpm += 5) {
      const double beat_s = 60 / bpm, step = 1e-7;
      const TimeWarp warp(recordedAt(keyframes), beat_s);
      const double recorded_s = 60 / keyframes;
      EXPECT_NEAR(warp.phaseAt(step) * recorded_s / step, 1, 1e-3) << keyframes << ' ' << bpm;
      EXPECT_NEAR((1 - warp.phaseAt(beat_s - step)) * recorded_s / step, 1, 1e-3)
          << keyframes << ' ' << bpm;
    }
}

TEST(TimeWarp, ChangesSmoothlyWithTheRateAlsoWhereDiastasisVanishes) {
  for (const double keyframes : {65.0, 110.0})
    for (double bpm = 95; bpm < 110; bpm += 0.02) {
      const TimeWarp a(recordedAt(keyframes), 60 / bpm),
          b(recordedAt(keyframes), 60 / (bpm + 0.02));
      for (int i = 0; i <= 100; ++i)
        ASSERT_NEAR(a.phaseAt(60 / bpm * i / 100), b.phaseAt(60 / (bpm + 0.02) * i / 100), 1.5e-3)
            << bpm << ' ' << i;
    }
}

}  // namespace
}  // namespace echocine
