// The filled share of a ventricle over the beat.

#include "motion/cycle/volume_curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace echocine {
namespace {

constexpr double kRates_bpm[] = {30, 40,    50,  60,  65,  70,  75, 90,
                                 99, 101.5, 110, 120, 150, 180, 220};

PhaseDurations durations(double bpm, Ventricle ventricle = Ventricle::left) {
  return phaseDurations(bpm / 60, ventricle);
}

// First phase from `start` on where the curve has left the level there by over `threshold`.
double leaves(const VolumeCurve& curve, double start, double threshold) {
  const double level = curve.at(start);
  double phase = start;
  while (phase < 1 && std::abs(curve.at(phase) - level) <= threshold) phase += 1e-5;
  return phase;
}

TEST(VolumeCurve, DurationsMeasuredBackFromTheCurveAreTheOnesItWasMadeOf) {
  constexpr double kThreshold = 1e-8, kTolerance_s = 0.002;
  for (const Ventricle ventricle : {Ventricle::left, Ventricle::right})
    for (const double bpm : kRates_bpm) {
      const PhaseDurations d = durations(bpm, ventricle);
      const VolumeCurve curve(d);
      const double beat_s = 60 / bpm;
      const double opens = leaves(curve, 0, kThreshold);
      double closes = opens;
      while (curve.at(closes) > kThreshold) closes += 1e-5;
      const double fills = leaves(curve, closes, 2 * kThreshold);
      EXPECT_NEAR(opens * beat_s, d.isovolumic_contraction_s, kTolerance_s) << bpm;
      EXPECT_NEAR((closes - opens) * beat_s, d.ejection_s, kTolerance_s) << bpm;
      EXPECT_NEAR((fills - closes) * beat_s, d.isovolumic_relaxation_s, 2 * kTolerance_s) << bpm;
    }
}

// A volume has two isovolumic rests and no wiggle: the law by which every kind of interpolation is
// judged.
TEST(VolumeCurve, FallsOnceRestsAndRisesOnceBetweenOneAndZero) {
  for (const Ventricle ventricle : {Ventricle::left, Ventricle::right})
    for (const double bpm : kRates_bpm) {
      const PhaseDurations d = durations(bpm, ventricle);
      const VolumeCurve curve(d);
      const CycleEvents e = cycleEvents(d);
      EXPECT_EQ(curve.at(0), 1);
      EXPECT_EQ(curve.at(1), 1);
      double before = 1;
      for (double phase = 0; phase < 1; phase += 1e-4) {
        const double now = curve.at(phase);
        ASSERT_GE(now, 0);
        ASSERT_LE(now, 1);
        if (phase <= e.aortic_opens) {
          ASSERT_EQ(now, 1);
        }
        if (phase < e.aortic_closes) {
          ASSERT_LE(now, before) << bpm << ' ' << phase;
        }
        if (phase >= e.aortic_closes && phase <= e.mitral_opens) {
          ASSERT_EQ(now, 0);
        }
        if (phase > e.mitral_opens) {
          ASSERT_GE(now, before) << bpm << ' ' << phase;
        }
        before = now;
      }
    }
}

// A kink would show as a difference quotient that does not shrink with the step.
TEST(VolumeCurve, HasNoKinkAlsoBetweenBeats) {
  for (const double bpm : kRates_bpm) {
    const PhaseDurations d = durations(bpm);
    const VolumeCurve curve(d);
    const CycleEvents e = cycleEvents(d);
    constexpr double kStep = 1e-6;
    for (const double knot : {e.aortic_opens, e.aortic_closes, e.mitral_opens, e.diastasis_begins,
                              e.atrial_kick_begins, 1 - kStep})
      EXPECT_NEAR((curve.at(knot + kStep) - curve.at(knot)) / kStep,
                  (curve.at(knot) - curve.at(knot - kStep)) / kStep, 2e-3)
          << bpm << ' ' << knot;
  }
}

// Published flow curves peak within the first third of ejection.
TEST(VolumeCurve, EjectionIsFastestInItsFirstThird) {
  for (const double bpm : kRates_bpm) {
    const PhaseDurations d = durations(bpm);
    const VolumeCurve curve(d);
    double fastest = 0, where = 0;
    for (double phase = 0; phase < 0.8; phase += 1e-4)
      if (const double rate = curve.at(phase) - curve.at(phase + 1e-4); rate > fastest)
        fastest = rate, where = phase;
    const CycleEvents e = cycleEvents(d);
    const double place = (where - e.aortic_opens) / (e.aortic_closes - e.aortic_opens);
    EXPECT_GT(place, 0.2) << bpm;
    EXPECT_LT(place, 1.0 / 3) << bpm;
  }
}

// Early filling 70 %, diastasis 20 %, atrial kick 10 % at rest; at high rates the kick takes over.
TEST(VolumeCurve, SharesAtRestAreSeventyTwentyTenAndTheKickTakesOverFromDiastasis) {
  for (const double bpm : {60.0, 65.0, 70.0}) {
    const CycleEvents e = cycleEvents(durations(bpm));
    const VolumeCurve curve(durations(bpm));
    EXPECT_NEAR(curve.at(e.diastasis_begins), 0.70, 1e-9);
    EXPECT_NEAR(curve.at(e.atrial_kick_begins), 0.90, 1e-9);
  }
  double before = 0.1 - 1e-12;
  for (const double bpm : kRates_bpm) {
    const double kick = VolumeCurve(durations(bpm)).kickShare();
    EXPECT_GE(kick, before - 1e-12) << bpm;
    before = kick;
  }
  EXPECT_NEAR(before, 0.30, 1e-12);
}

// Of two rates a hundredth apart no phase may differ by more than a thousandth of the stroke
// volume.
TEST(VolumeCurve, ChangesSmoothlyWithTheRateWhereDiastasisVanishes) {
  for (double bpm = 95; bpm < 110; bpm += 0.01) {
    const VolumeCurve a(durations(bpm)), b(durations(bpm + 0.01));
    for (double phase = 0; phase < 1; phase += 0.01) ASSERT_NEAR(a.at(phase), b.at(phase), 1e-3);
  }
}

}  // namespace
}  // namespace echocine
