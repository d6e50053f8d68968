// The cardiac clock and the electrocardiogram.

#include "motion/cardiac_clock.h"

#include "motion/ecg.h"
#include "tests/stage/motion_fixtures.h"

namespace echocine::motion_test {
namespace {

CardiacClock clockOf(double heart_rate_bpm, double frame_rate_hz, double beats) {
  return CardiacClock({heart_rate_bpm / 60.0, frame_rate_hz, beats});
}

TEST(MotionClock, FramesAreTheBeatsRoundedToWholeFramesAndAtLeastOne) {
  EXPECT_EQ(clockOf(60, 50, 1).frameCount(), 50);
  EXPECT_EQ(clockOf(65, 50, 1).frameCount(), 46);
  EXPECT_EQ(clockOf(72, 30, 3).frameCount(), 75);
  EXPECT_EQ(clockOf(60, 50, 0.001).frameCount(), 1);
}

TEST(MotionClock, PhaseCountsBeatsFromTheRWave) {
  const CardiacClock clock = clockOf(60, 50, 2);
  EXPECT_EQ(clock.at(0).phase, 0.0);
  EXPECT_DOUBLE_EQ(clock.at(10).time_s, 0.2);
  EXPECT_NEAR(clock.at(10).phase, 0.2, 1e-15);
  EXPECT_NEAR(clock.at(60).phase, 0.2, 1e-14);
}

TEST(MotionClock, PhaseStaysBelowOneAndWholeBeatsAreZero) {
  for (const double bpm : {30.0, 59.9, 65.0, 72.0, 77.0, 140.0, 187.3})
    for (const double rate : {17.0, 29.97, 30.0, 50.0, 83.3}) {
      const CardiacClock clock = clockOf(bpm, rate, 1);
      for (int frame = 0; frame < 3000; ++frame) {
        const double phase = clock.at(frame).phase;
        ASSERT_GE(phase, 0.0);
        ASSERT_LT(phase, 1 - 1e-10) << bpm << ' ' << rate << ' ' << frame;
      }
    }
  // 65 bpm at 52 Hz is a beat every 48 frames, which 65.0 / 60.0 does not hit exactly.
  for (int beat = 0; beat < 50; ++beat) EXPECT_EQ(clockOf(65, 52, 1).at(48 * beat).phase, 0.0);
}

TEST(MotionEcg, WavesStandWhereTheModelPutsThem) {
  EXPECT_DOUBLE_EQ(ecgAmplitude(0), 1.0);
  const double p = ecgAmplitude(1 - 1.0 / 6), q = ecgAmplitude(1 - 1.0 / 24);
  const double s = ecgAmplitude(1.0 / 24), t = ecgAmplitude(0.25);
  EXPECT_NEAR(p, 0.25, 0.03);  // 1.2 * 0.25^2 / (30 * 0.1^2)
  EXPECT_NEAR(t, 0.40, 0.01);  // 0.75 * 0.4^2 / (30 * 0.1^2)
  EXPECT_LT(q, 0.0);
  EXPECT_LT(s, q);
  EXPECT_NEAR(ecgAmplitude(0.6), 0.0, 0.05);  // diastole is flat
}

TEST(MotionEcg, RIsTheHighestPointAndTheTraceIsPeriodic) {
  for (int i = 0; i < 1000; ++i) EXPECT_LE(ecgAmplitude(i / 1000.0), 1.0 + 1e-4);
  EXPECT_NEAR(ecgAmplitude(1 - 1e-12), ecgAmplitude(0), 1e-9);
  for (int i = 0; i < 1000; ++i)
    EXPECT_NEAR(ecgAmplitude(i / 1000.0), ecgAmplitude((i + 1e-6) / 1000.0), 1e-6);
}

}  // namespace
}  // namespace echocine::motion_test
