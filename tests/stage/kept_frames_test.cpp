// Frames that are kept between two passes: those of the range, once each, within a bound of memory.

#include "loop/kept_frames.h"

#include <gtest/gtest.h>

namespace echocine {
namespace {

PolarFrame frameOf(int lines, int samples) {
  PolarFrame frame;
  frame.lines = lines;
  frame.samples = samples;
  frame.intensities.resize(1);  // how many there are is counted by lines and samples
  return frame;
}

bool taken(KeptFrames& kept, int frame) {
  PolarFrame polar;
  Volumes volumes_ml;
  return kept.take(frame, polar, volumes_ml);
}

TEST(KeptFrames, HoldsTheFramesOfItsRangeAndGivesEachOnce) {
  KeptFrames kept({2, 5});
  for (int frame = 0; frame < 8; ++frame) kept.keep(frame, frameOf(4, 4), {});
  for (int frame = 0; frame < 8; ++frame) {
    EXPECT_EQ(taken(kept, frame), frame >= 2 && frame < 5) << frame;
    EXPECT_FALSE(taken(kept, frame)) << frame;
  }
}

TEST(KeptFrames, HoldsTheFirstFramesThatFit) {
  constexpr int kWide = 4096;  // 64 MiB a frame
  static_assert(kKeptBytes == 2 * sizeof(float) * kWide * kWide);
  KeptFrames kept({0, 4});
  for (int frame = 0; frame < 4; ++frame) kept.keep(frame, frameOf(kWide, kWide), {});
  for (int frame = 0; frame < 4; ++frame) EXPECT_EQ(taken(kept, frame), frame < 2) << frame;
}

}  // namespace
}  // namespace echocine
