// The parts of a heartbeat at every heart rate: published durations, and what must hold of any.

#include "motion/cycle/cardiac_timing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "motion/cycle/volume_curve.h"

namespace echocine {
namespace {

std::vector<double> parts(const PhaseDurations& d) {
  return {d.isovolumic_contraction_s, d.ejection_s,  d.isovolumic_relaxation_s,
          d.rapid_filling_s,          d.diastasis_s, d.atrial_kick_s};
}

PhaseDurations at(double bpm, Ventricle ventricle = Ventricle::left) {
  return phaseDurations(bpm / 60, ventricle);
}

// Means and standard deviations: ejection by the two regressions (rest at 50 and 75, exercise at
// 120), isovolumic phases of the Copenhagen City Heart Study.
TEST(CardiacTiming, DurationsAreThePublishedOnesWithinTheirStandardDeviations) {
  struct Row {
    double bpm, ejection_s, sd_s;
  };
  for (const Row& row : {Row{50, 0.289, 0.011}, Row{75, 0.244, 0.011}, Row{120, 0.227, 0.014}}) {
    const PhaseDurations d = at(row.bpm);
    EXPECT_NEAR(d.ejection_s, row.ejection_s, row.sd_s) << row.bpm;
    EXPECT_NEAR(d.isovolumic_contraction_s, 0.040, 0.010) << row.bpm;
    EXPECT_NEAR(d.isovolumic_relaxation_s, 0.096, 0.019) << row.bpm;
  }
  // The mean over that study is 292 +- 23 ms: 1.3 standard deviations above the line at 65 bpm.
  EXPECT_NEAR(at(65).ejection_s, 0.292, 1.5 * 0.023);
}

TEST(CardiacTiming, PartsAreTheBeatAndNoneIsNegativeNorGrowsWithTheRate) {
  for (const Ventricle ventricle : {Ventricle::left, Ventricle::right}) {
    std::vector<double> before = parts(at(29.9, ventricle));
    for (double bpm = 30; bpm <= 220; bpm += 0.1) {
      const PhaseDurations d = at(bpm, ventricle);
      ASSERT_DOUBLE_EQ(d.beat(), 60 / bpm) << bpm;
      const std::vector<double> now = parts(d);
      for (std::size_t i = 0; i < now.size(); ++i) {
        ASSERT_GE(now[i], 0) << bpm << ' ' << i;
        ASSERT_LE(now[i], before[i] + 1e-15) << bpm << ' ' << i;
        ASSERT_LT(before[i] - now[i], 0.008) << bpm << ' ' << i;  // no jump: 6.7 ms/0.1 bpm at 30
      }
      before = now;
    }
  }
}

// A jump would show as a loop that changes its shape from 104.9 to 105 beats per minute.
TEST(CardiacTiming, NoPartJumpsAtAnyRate) {
  for (const Ventricle ventricle : {Ventricle::left, Ventricle::right})
    for (double bpm = 30; bpm <= 220; bpm += 0.25) {
      const std::vector<double> a = parts(at(bpm, ventricle)), b = parts(at(bpm + 1e-6, ventricle));
      for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], 1e-7) << bpm << ' ' << i;
    }
}

// However fast it beats, a ventricle needs time to empty and to fill.
TEST(CardiacTiming, EjectionKeepsTheTimeThatTheHeartNeeds) {
  for (double bpm = 30; bpm <= 220; bpm += 1) {
    EXPECT_GE(at(bpm).ejection_s, 0.120) << bpm;
    EXPECT_GE(at(bpm).filling(), 0.070) << bpm;
  }
}

// What everybody sees on an echo: fast hearts have no rest.
TEST(CardiacTiming, DiastasisShortensMostAndIsGoneFromAbout105) {
  const std::vector<double> slow = parts(at(50)), fast = parts(at(90));
  const double lost = slow[4] - fast[4];
  for (const std::size_t other : {0u, 1u, 2u, 3u, 5u})
    EXPECT_GT(lost, 5 * (slow[other] - fast[other]));
  EXPECT_GT(at(99).diastasis_s, 0);
  EXPECT_EQ(at(105).diastasis_s, 0);
  EXPECT_EQ(at(220).diastasis_s, 0);
}

// The lung's pressure is a fifth of the body's, so the right valve opens earlier and closes later.
TEST(CardiacTiming, TheRightVentricleEjectsForLongerBetweenShorterIsovolumicPhases) {
  for (double bpm = 30; bpm <= 220; bpm += 10) {
    const PhaseDurations left = at(bpm), right = at(bpm, Ventricle::right);
    EXPECT_GT(right.ejection_s, left.ejection_s);
    EXPECT_LT(right.isovolumic_contraction_s, left.isovolumic_contraction_s);
    EXPECT_LT(right.isovolumic_relaxation_s, left.isovolumic_relaxation_s);
    EXPECT_EQ(right.atrial_kick_s, left.atrial_kick_s);
  }
}

TEST(CardiacTiming, EventsAscendAndEndSystoleIsAboutAThirdAtRest) {
  for (double bpm = 30; bpm <= 220; bpm += 0.5) {
    const CycleEvents e = cycleEvents(at(bpm));
    EXPECT_EQ(e.mitral_closes, 0);
    EXPECT_LT(0, e.aortic_opens);
    EXPECT_LT(e.aortic_opens, e.aortic_closes);
    EXPECT_LT(e.aortic_closes, e.mitral_opens);
    EXPECT_LT(e.mitral_opens, e.diastasis_begins);
    EXPECT_LE(e.diastasis_begins, e.atrial_kick_begins);
    EXPECT_LT(e.atrial_kick_begins, 1);
  }
  EXPECT_NEAR(cycleEvents(at(65)).aortic_closes, (0.040 + 0.262) / (60.0 / 65), 1e-12);
}

}  // namespace
}  // namespace echocine
