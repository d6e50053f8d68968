// The length of a beat where R waves are missing: R waves give the times, the pictures how many
// beats lie between two.

#include <gtest/gtest.h>

#include <cmath>

#include "echo/beat_length.h"
#include "echo/r_wave_beats.h"
#include "support/drawn_heart.h"

namespace echocine::echo {
namespace {

TEST(RWaveBeats, AMissingWaveLeavesTheLength) {
  const std::vector<double> all{3, 23.5, 43, 63.5, 84};
  const double beat = (84.0 - 3) / 4;
  EXPECT_DOUBLE_EQ(beatOfRWaves(all, 0).mean, beat);
  for (std::size_t i = 1; i + 1 < all.size(); ++i) {
    std::vector<double> waves = all;
    waves.erase(waves.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_DOUBLE_EQ(beatOfRWaves(waves, 0).mean, beat) << i;
    EXPECT_NEAR(beatOfRWaves(waves, 0).median, beat, 1) << i;
  }
}

// Two waves alone: only the pictures can tell.
TEST(RWaveBeats, ThePicturesDivideTheOnlyInterval) {
  for (const double seen : {0.0, 40.0, 38.0, 26.0, 13.0, 9.0})
    EXPECT_DOUBLE_EQ(beatOfRWaves({5, 45}, seen).mean, seen == 13 ? 40.0 / 3 : 40) << seen;
  for (const double seen : {19.0, 20.0, 21.5})
    EXPECT_DOUBLE_EQ(beatOfRWaves({5, 45}, seen).median, 20) << seen;
  EXPECT_EQ(beatOfRWaves({5}, 20).mean, 0);
}

// An early beat and the pause after it are one beat each, as are those of an irregular rhythm.
TEST(RWaveBeats, AnEarlyBeatIsOne) {
  EXPECT_DOUBLE_EQ(beatOfRWaves({0, 20, 32, 60, 80}, 20).mean, 20);
  EXPECT_DOUBLE_EQ(beatOfRWaves({0, 20, 32, 60, 80}, 20).median, 20);
  EXPECT_EQ(beatsBetween(12, 20), 1);
  EXPECT_EQ(beatsBetween(32, 20), 1);
  EXPECT_EQ(beatsBetween(41, 20), 2);
  EXPECT_EQ(beatsBetween(41, 0), 1);
}

// A drawn loop of two and a half beats whose speckle never repeats.
EchoLoop severalBeats() {
  constexpr int kBeat = 12, kFrames = 30;
  EchoLoop loop = support::draw({}, {}, kBeat, 1);
  for (std::uint64_t seed = 2; loop.video.frameCount() < kFrames; ++seed)
    for (PixelPlane& frame : support::draw({}, {}, kBeat, seed).video.frames)
      if (loop.video.frameCount() < kFrames) loop.video.frames.push_back(std::move(frame));
  loop.frames_per_beat = 0;
  loop.video.rate = {12, "planted", true};
  return loop;
}

TEST(RWaveBeats, ALoopWithOneOrWithoutEverySecondWaveHasItsBeat) {
  EchoLoop loop = severalBeats();
  for (const std::vector<double>& waves :
       {std::vector<double>{}, {0.2}, {0.2, 1.2, 2.2}, {0.2, 2.2}}) {
    loop.video.r_waves_s = waves;
    EXPECT_NEAR(beatOf(loop).frames, 12, 0.3) << waves.size();
    EXPECT_EQ(beatOf(loop).source, waves.size() < 2 ? "self-similarity" : "R waves");
  }
}

}  // namespace
}  // namespace echocine::echo
