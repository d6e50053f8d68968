// The electrocardiogram: where its waves stand, at every rate.

#include "motion/cycle/ecg.h"

#include <gtest/gtest.h>

#include <cmath>

#include "motion/cycle/cardiac_timing.h"

namespace echocine {
namespace {

TEST(MotionEcg, WavesStandWhereTheModelPutsThemAt60) {
  EXPECT_DOUBLE_EQ(ecgAmplitude(0, 1), 1.0);
  const double p = ecgAmplitude(1 - 1.0 / 6, 1), q = ecgAmplitude(1 - 1.0 / 24, 1);
  const double s = ecgAmplitude(1.0 / 24, 1), t = ecgAmplitude(0.25, 1);
  EXPECT_NEAR(p, 0.25, 0.03);  // 1.2 * 0.25^2 / (30 * 0.1^2)
  EXPECT_NEAR(t, 0.40, 0.01);  // 0.75 * 0.4^2 / (30 * 0.1^2)
  EXPECT_LT(q, 0.0);
  EXPECT_LT(s, q);
  EXPECT_NEAR(ecgAmplitude(0.6, 1), 0.0, 0.05);  // diastole is flat
}

TEST(MotionEcg, RIsTheHighestPointAtTheBeatsStartAtEveryRate) {
  for (double bpm = 30; bpm <= 220; bpm += 2) {
    const double beat_s = 60 / bpm;
    for (int i = 0; i < 1000; ++i) {
      const double time_s = beat_s * i / 1000;
      ASSERT_LE(ecgAmplitude(time_s, beat_s), 1.0 + 1e-3) << bpm << ' ' << i;
      ASSERT_NEAR(ecgAmplitude(time_s, beat_s), ecgAmplitude(time_s + 1e-6, beat_s), 1e-4);
    }
    EXPECT_EQ(ecgAmplitude(0, beat_s), 1);
    EXPECT_NEAR(ecgAmplitude(beat_s, beat_s), 1, 1e-4);
  }
}

// Beats of different lengths join: around R the trace is the QRS complex alone.
TEST(MotionEcg, BeatsOfDifferentLengthsJoin) {
  for (double bpm = 30; bpm <= 150; bpm += 5)
    for (double next_bpm = 30; next_bpm <= 150; next_bpm += 5) {
      const double beat_s = 60 / bpm;
      EXPECT_NEAR(ecgAmplitude(beat_s - 1e-9, beat_s), ecgAmplitude(1e-9, 60 / next_bpm), 1e-3);
      EXPECT_NEAR(ecgAmplitude(beat_s + 0.01, beat_s), ecgAmplitude(0.01, 60 / next_bpm), 6e-3);
    }
}

// Width of R where the trace is over half of it.
TEST(MotionEcg, QrsKeepsItsTimeAtEveryRate) {
  const auto width = [](double beat_s) {
    double t = 0;
    while (ecgAmplitude(t, beat_s) > 0.5) t += 1e-5;
    return t;
  };
  for (double bpm = 30; bpm <= 200; bpm += 10) EXPECT_NEAR(width(60 / bpm), width(1), 0.001) << bpm;
}

// QT from two widths before Q to two widths after T, where the tangent of a Gaussian meets zero.
TEST(MotionEcg, QtFollowsBazettsRuleAndStaysInTheBeat) {
  constexpr double kPi = 3.14159265358979323846;
  const double q_onset = 1.0 / 24 + 2 * 0.1 / (2 * kPi), t_width = 0.4 / (2 * kPi);
  for (double bpm = 30; bpm <= 220; bpm += 5) {
    const double beat_s = 60 / bpm, root = std::sqrt(beat_s);
    EXPECT_NEAR(tPeakAfterR(beat_s), 0.25 * root, 1e-12);
    const double end = tPeakAfterR(beat_s) + 2 * t_width * root;
    EXPECT_LT(end, beat_s) << bpm;
    if (bpm < 50 || bpm > 120) continue;
    EXPECT_NEAR((q_onset + end) / root, 0.45, 0.04) << bpm;
    // The highest point between S and diastole is where T is said to be.
    double highest = 0.1;
    for (double t = 0.1; t < 0.6 * beat_s; t += 1e-4)
      if (ecgAmplitude(t, beat_s) > ecgAmplitude(highest, beat_s)) highest = t;
    EXPECT_NEAR(highest, tPeakAfterR(beat_s), 0.003) << bpm;
  }
}

TEST(MotionEcg, TheAtrialKickFollowsThePWaveAndEndSystoleFallsOnTheDownslopeOfT) {
  for (double bpm = 30; bpm <= 220; bpm += 5) {
    const double beat_s = 60 / bpm;
    const PhaseDurations d = phaseDurations(bpm / 60);
    EXPECT_GT(pPeakBeforeR(beat_s), d.atrial_kick_s) << bpm;
    EXPECT_LT(pPeakBeforeR(beat_s), d.atrial_kick_s + 0.160) << bpm;
    const double t_width = 0.4 / (2 * 3.14159265358979323846) * std::sqrt(beat_s);
    EXPECT_GT(d.endSystole(), tPeakAfterR(beat_s)) << bpm;
    EXPECT_LT(d.endSystole(), tPeakAfterR(beat_s) + 2 * t_width) << bpm;
  }
}

}  // namespace
}  // namespace echocine
