// Eq. 26: a recursive average of unrelated noise has its share of the previous picture.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/hash_random.h"
#include "echo/persistence.h"

namespace echocine::echo {
namespace {

constexpr int kWidth = 240, kHeight = 200;

// Grain of independent pixels around a grey level that differs from place to place, with the share
// p of the previous picture. Frames `repeats` are those before them.
EchoLoop loopOf(double p, int frames, const std::vector<int>& repeats = {}) {
  EchoLoop loop;
  loop.video.width = kWidth, loop.video.height = kHeight;
  loop.find.sector = {0.5 * kWidth, 0, -0.7, 0.7, 5, 190};
  loop.video.repeats = repeats;
  std::vector<double> state(static_cast<std::size_t>(kWidth) * kHeight);
  const auto noise = [](int frame, std::size_t i) {
    return 20 * (uniformFromHash(hashOf(frame, i, 5)) - 0.5);
  };
  // The deviation of an average is smaller: scaled back, so that greys keep their resolution.
  const double scale = std::sqrt((1 + p) / (1 - p));
  for (int f = -40; f < frames; ++f) {
    if (f > 0 && loop.video.isRepeat(f)) {
      loop.video.frames.push_back(loop.video.frames.back());
      continue;
    }
    for (std::size_t i = 0; i < state.size(); ++i) state[i] = p * state[i] + (1 - p) * noise(f, i);
    if (f < 0) continue;
    PixelPlane plane(state.size());
    for (std::size_t i = 0; i < plane.size(); ++i) {
      const double anatomy =
          100 + 40 * std::sin(2 * std::numbers::pi * static_cast<double>(i % kWidth) / 50);
      plane[i] = static_cast<std::uint8_t>(std::lround(anatomy + scale * state[i]));
    }
    loop.video.frames.push_back(plane);
  }
  return loop;
}

TEST(Persistence, IsTheShareOfThePreviousPicture) {
  for (const double p : {0.0, 0.1, 0.2, 0.35})
    EXPECT_NEAR(persistenceOf(loopOf(p, 30)).value(), p, 0.04) << p;
  // Above, the ratio also has motion: it stands for 0.64 of it, and at least 0.4.
  EXPECT_NEAR(persistenceOf(loopOf(0.5, 30)).value(), 0.4, 1e-6);
  EXPECT_NEAR(persistenceOf(loopOf(0.75, 60)).value(), 0.64 * 0.75, 0.05);
}

TEST(Persistence, RepeatedFramesAreNone) {
  EXPECT_NEAR(persistenceOf(loopOf(0.2, 30, {3, 4, 11, 25})).value(), 0.2, 0.04);
}

TEST(Persistence, IsUnknownWithoutPicturesOrEchoes) {
  EXPECT_FALSE(persistenceOf(loopOf(0.2, 7)).has_value());
  EXPECT_TRUE(persistenceOf(loopOf(0.2, 8)).has_value());
  EchoLoop covered = loopOf(0.2, 20);
  covered.overlay.assign(static_cast<std::size_t>(kWidth) * kHeight, 1);
  EXPECT_FALSE(persistenceOf(covered).has_value());
  EchoLoop black = loopOf(0.2, 20);
  for (PixelPlane& plane : black.video.frames) plane.assign(plane.size(), 3);
  EXPECT_FALSE(persistenceOf(black).has_value());
}

TEST(Persistence, LagIsTheMeanAgeOfAPicture) {
  EXPECT_EQ(lagFrames(0), 0);
  for (const double p : {0.35, 0.5, 0.8}) {
    double age = 0;
    for (int k = 0; k < 200; ++k) age += k * (1 - p) * std::pow(p, k);
    EXPECT_NEAR(lagFrames(p), age, 1e-9);
  }
}

}  // namespace
}  // namespace echocine::echo
