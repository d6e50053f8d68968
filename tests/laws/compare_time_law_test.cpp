// Planted shifts, paces and beats are found again, and no beat where there is none.

#include <gtest/gtest.h>

#include <cmath>

#include "compare/time_alignment.h"
#include "core/hash_random.h"
#include "echo/beat_length.h"

namespace echocine::compare {

using namespace echo;
namespace {

// Frames of a wheel: what moves is known at any instant.
Features wheel(const std::vector<double>& phases) {
  Features f;
  for (const double p : phases) {
    std::vector<double> v;
    for (int h = 1; h <= 3; ++h) {
      v.push_back(std::cos(2 * M_PI * h * p) / h);
      v.push_back(std::sin(2 * M_PI * h * p) / h);
    }
    f.push_back(v);
  }
  return f;
}

std::vector<double> even(int n, double beat, double shift = 0) {
  std::vector<double> p;
  for (int i = 0; i < n; ++i) p.push_back((i + shift) / beat);
  return p;
}

// Planted shifts, also between frames.
TEST(TimeAlignmentLaw, AShiftIsFoundToATenthOfAFrame) {
  for (const double shift : {0.0, 0.5, 7.25, 19.5}) {
    const Features s = wheel(even(24, 24)), r = wheel(even(24, 24, shift));
    const TimeAlignment t = alignInTime({s, r, 24, 24, 1, {}});
    EXPECT_NEAR(std::remainder(t.shift_frames - shift, 24), 0, 0.1) << shift;
    EXPECT_GT(t.correlation, 0.98);
    for (std::size_t j = 0; j < r.size(); ++j)
      EXPECT_NEAR(std::remainder(t.place[j] - shift - double(j), 24), 0, 0.26) << j;
  }
}

// Places advance by the ratio of the rates, which nobody tells here.
TEST(TimeAlignmentLaw, AnotherFrameRateIsFoundWithoutKnownBeats) {
  const Features s = wheel(even(40, 40)), r = wheel(even(22, 30, 3));
  const TimeAlignment t = alignInTime({s, r, 0, 0, 1.2, {}});
  EXPECT_NEAR(t.rate, 40.0 / 30, 0.03);
}

// Systole stretched: the straight map is wrong by 2 frames, the warp finds it.
TEST(TimeAlignmentLaw, AWarpedBeatIsFound) {
  const int n = 40;
  const auto warp = [](double p) { return p + 0.045 * std::sin(2 * M_PI * p); };
  std::vector<double> phases;
  for (int i = 0; i < n; ++i) phases.push_back(warp(double(i) / n));
  const Features s = wheel(even(n, n)), r = wheel(phases);
  const TimeAlignment t = alignInTime({s, r, double(n), double(n), 1, {}});
  double worst = 0;
  for (int j = 0; j < n; ++j)
    worst = std::max(
        worst, std::abs(std::remainder(t.place[std::size_t(j)] - n * phases[std::size_t(j)], n)));
  EXPECT_LT(worst, 0.75);
  EXPECT_GT(t.largest_warp_frames, 1);
  for (std::size_t j = 1; j < std::size_t(n); ++j)  // never backwards
    EXPECT_GE(std::remainder(t.place[j] - t.place[j - 1], n), -1e-9);
}

// What is known is met, and nothing is invented between.
TEST(TimeAlignmentLaw, AnchorsAreMetAndStraightBetween) {
  const Features s = wheel(even(30, 30)), r = wheel(even(20, 20));
  TimeAlignment t = alignByAnchors({s, r, 30, 20, 1, {}}, {{2, 0}, {8, 12}});
  EXPECT_NEAR(t.place[2], 0, 1e-9);
  EXPECT_NEAR(t.place[5], 6, 1e-9);
  EXPECT_NEAR(t.place[8], 12, 1e-9);
  EXPECT_NEAR(t.place[15], 12 + 18.0 * 7 / 14, 1e-9);  // the rest of the beat, evenly
}

// R waves over several beats of other lengths than the stated one: frames outside them go on at the
// mean pace.
TEST(TimeAlignmentLaw, FramesOutsideRWavesOfSeveralBeatsGoOn) {
  const Features s = wheel(even(30, 30)), r = wheel(even(170, 50));
  const TimeAlignment t =
      alignByAnchors({s, r, 30, 50, 1, {}}, {{10, 0}, {60, 30}, {110, 60}, {150, 90}});
  const auto isAt = [&](std::size_t frame, double place) {
    EXPECT_NEAR(std::remainder(t.place[frame] - place, 30), 0, 1e-9) << frame;
  };
  isAt(0, -6);
  isAt(9, -0.6);
  isAt(10, 0);
  isAt(35, 15);
  isAt(130, 15);
  isAt(150, 0);
  isAt(160, 6);
  isAt(169, 11.4);
}

// One that is not there must not be found: a false beat pairs all frames wrongly.
TEST(BeatLengthLaw, BeatsAreFoundAndTheirAbsenceToo) {
  const BeatLength two = findBeatLength(wheel(even(50, 20.4)), 5);
  EXPECT_NEAR(two.frames, 20.4, 0.1);
  EXPECT_GT(two.confidence, 0.9);
  const BeatLength one = findBeatLength(wheel(even(30, 30)), 6);
  EXPECT_NEAR(one.frames, 30, 1e-9);
  EXPECT_EQ(one.source, "loop closes");
  EXPECT_EQ(findBeatLength(wheel(even(20, 60)), 5).frames, 0);  // a third of a beat
}

}  // namespace
}  // namespace echocine::compare
