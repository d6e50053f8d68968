// The cardiac clock.

#include "motion/cycle/cardiac_clock.h"

#include "motion/cycle/beat_duration.h"
#include "motion/cycle/cardiac_timing.h"
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

// 1 - 1e-17 rounds to 1, which is no phase: it must come out as 0.
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

Acquisition acquisitionOf(double heart_rate_bpm, double frame_rate_hz, double beats) {
  return {heart_rate_bpm / 60.0, frame_rate_hz, beats};
}

MotionSettings recordedAt(double bpm) {
  MotionSettings motion;
  motion.keyframe_heart_rate_hz = bpm / 60.0;
  return motion;
}

TEST(MotionClock, AtTheKeyframesOwnRateAndOnRequestNothingIsWarpedToTheLastBit) {
  for (const double bpm : {30.0, 65.0, 77.0, 140.0}) {
    Acquisition acquisition = acquisitionOf(bpm, 29.97, 3);
    const CardiacClock plain(acquisition), same(acquisition, recordedAt(bpm));
    acquisition.time_warp = WarpChoice::uniform;
    const CardiacClock uniform(acquisition, recordedAt(50));
    for (int frame = 0; frame < plain.frameCount(); ++frame) {
      ASSERT_EQ(same.at(frame).phase, plain.at(frame).phase);
      ASSERT_EQ(uniform.at(frame).phase, plain.at(frame).phase);
      // As it was before beats could be warped.
      const double cycles = frame * (bpm / 60.0) / 29.97;
      if (std::abs(cycles - std::round(cycles)) < 1e-6) continue;
      ASSERT_EQ(plain.at(frame).phase, cycles - std::floor(cycles));
    }
  }
}

TEST(MotionClock, KeyframesOfAnotherRateReachEndSystoleInItsTime) {
  const CardiacClock clock(acquisitionOf(120, 1000, 2), recordedAt(60));
  // At 60 bpm the aortic valve closes at 311 ms = phase 0.312, at 120 it does at 262 ms = 0.523.
  const double recorded = (0.040 * 271 / 262 + 0.271);
  EXPECT_NEAR(clock.at(262).phase, recorded, 0.002);
  EXPECT_NEAR(clock.at(762).phase, recorded, 0.002);
  EXPECT_EQ(clock.at(500).phase, 0);
  EXPECT_EQ(clock.at(500).beat, 1);
  EXPECT_DOUBLE_EQ(clock.at(762).time_in_beat_s, 0.262);
  EXPECT_EQ(clock.frameCount(), 1000);
}

TEST(MotionClock, BeatsAreCountedAndStartAtPhaseZero) {
  const CardiacClock clock = clockOf(60, 50, 3);
  for (int frame = 0; frame < 150; ++frame) {
    EXPECT_EQ(clock.at(frame).beat, frame / 50);
    EXPECT_NEAR(clock.at(frame).time_in_beat_s, frame % 50 / 50.0, 1e-12);
    EXPECT_EQ(clock.at(frame).beat_s, 1);
  }
}

TEST(MotionClock, VariedBeatsFillTheLoopOneAfterTheOther) {
  for (const std::optional<double>& keyframes : {std::optional<double>(), std::optional(70.0)}) {
    Acquisition acquisition = acquisitionOf(70, 200, 12.25);
    acquisition.rr_variability = 0.2;
    acquisition.seed = 9;
    const CardiacClock clock(acquisition, keyframes ? recordedAt(*keyframes) : MotionSettings{});
    double whole_s = 0;
    for (int beat = 0; beat < 12; ++beat) whole_s += beatDuration(acquisition, beat);
    const double loop_s = whole_s + 0.25 * beatDuration(acquisition, 12);
    EXPECT_EQ(clock.frameCount(), std::lround(loop_s * 200));
    FrameTime before = clock.at(0);
    EXPECT_EQ(before.phase, 0);
    for (int frame = 1; frame < clock.frameCount(); ++frame) {
      const FrameTime now = clock.at(frame);
      EXPECT_DOUBLE_EQ(now.time_s, frame / 200.0);
      EXPECT_NEAR(now.beat_s, beatDuration(acquisition, now.beat), 1e-12);
      if (now.beat == before.beat) {
        EXPECT_GT(now.phase, before.phase);
      } else {
        EXPECT_EQ(now.beat, before.beat + 1);
        EXPECT_LT(now.time_in_beat_s, 1 / 200.0 + 1e-9);
        EXPECT_LT(now.phase, 0.02);
      }
      before = now;
    }
    EXPECT_EQ(before.beat, 12);
  }
}

TEST(MotionClock, VariedBeatsWarpEachByItsOwnLength) {
  Acquisition acquisition = acquisitionOf(70, 1000, 40);
  acquisition.rr_variability = 0.15;
  const CardiacClock clock(acquisition, recordedAt(70));
  const double recorded = cycleEvents(phaseDurations(70 / 60.0)).aortic_closes;
  int ends = 0;
  for (int frame = 1; frame < clock.frameCount(); ++frame) {
    const FrameTime before = clock.at(frame - 1), now = clock.at(frame);
    if (now.beat != before.beat || before.phase >= recorded || now.phase < recorded) continue;
    EXPECT_NEAR(now.time_in_beat_s, phaseDurations(1 / now.beat_s).endSystole(), 0.0015);
    ++ends;
  }
  EXPECT_EQ(ends, 40);
}

// One to a thousand beats a minute, frames from 10 s down to 10 us apart.
// Within a billionth of a beat before the next R wave it is the R wave: warped and varied too.
TEST(MotionClock, NoPhaseLiesWithinABillionthOfTheNextBeat) {
  for (const double variability : {0.0, 0.2})
    for (const double keyframes : {40.0, 65.0, 140.0})
      for (const double bpm : {45.0, 65.0, 130.0}) {
        Acquisition acquisition = acquisitionOf(bpm, 50, 12);
        acquisition.rr_variability = variability;
        const CardiacClock clock(acquisition, recordedAt(keyframes));
        double end_s = 0;
        for (int beat = 0; beat < 12; ++beat) {
          end_s += clock.atTime(end_s + 0.1).beat_s;
          for (int i = 1; i <= 60; ++i) {
            const double phase = clock.atTime(end_s - 5e-11 * i * 60 / bpm).phase;
            ASSERT_LT(phase, 1 - 1e-9) << bpm << ' ' << keyframes << ' ' << beat << ' ' << i;
          }
        }
      }
}

TEST(MotionClock, ExtremeSettingsStayFiniteAndInTheBeat) {
  for (const double bpm : {1.0, 30.0, 1000.0})
    for (const double variability : {0.0, 0.3})
      for (const double keyframes : {1.0, 65.0, 1000.0})
        for (const double frame_rate : {0.1, 50.0, 100000.0}) {
          Acquisition acquisition = acquisitionOf(bpm, frame_rate, 0.3);
          acquisition.rr_variability = variability;
          const CardiacClock clock(acquisition, recordedAt(keyframes));
          ASSERT_GE(clock.frameCount(), 1);
          for (int i = 0; i < 50; ++i) {
            const int frame = static_cast<int>(std::int64_t{i} * clock.frameCount() / 50);
            const FrameTime time = clock.at(frame);
            ASSERT_TRUE(time.phase >= 0 && time.phase < 1) << time.phase;
            ASSERT_EQ(clock.atTime(time.time_s).beat, time.beat);
          }
          ASSERT_GE(clock.atTime(clock.frameCount() / frame_rate).beat_s, 0);
        }
}

}  // namespace
}  // namespace echocine::motion_test
