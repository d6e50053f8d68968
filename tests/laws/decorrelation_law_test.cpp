// Correlation of a block of muscle along its track, against closed forms.

#include <gtest/gtest.h>

#include <cmath>

#include "core/hash_random.h"
#include "dataset/decorrelation.h"
#include "support/measured.h"

namespace echocine::dataset {
namespace {

constexpr int kSide = 160;

// A grain of noise that is attached to the material; `fresh` is a share of new noise per frame.
double grain(int x, int y, int layer) {
  return 2 * uniformFromHash(hashOf(static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(y),
                                    static_cast<std::uint64_t>(layer))) -
         1;
}

// A loop of a linear probe that is 0.5 mm a pixel, so blocks meet pixel centres.
LoopSample loopOf(int frames) {
  LoopSample loop;
  loop.scene.acquisition.frame_rate_hz = 50;
  loop.scene.output.width = loop.scene.output.height = kSide;
  loop.scene.probe.kind = ProbeKind::linear;
  loop.scene.probe.first_offset_m = -0.04;
  loop.scene.probe.last_offset_m = 0.04;
  loop.scene.probe.min_depth_m = 0;
  loop.scene.probe.max_depth_m = 0.08;
  loop.scene.probe.frequency_hz = 2.5e6;
  loop.scene.probe.elevation_aperture_m = 0.013;
  loop.scene.probe.elevation_focus_m = 0.07;
  loop.geometry = {kSide / 2.0, 0, kBlockStep_m, 0};
  for (std::uint32_t n = 0; n < 4; ++n) loop.tracked.push_back({1, 1, n});
  loop.tracked.push_back({0, 1, 9});  // endocardium: not followed
  loop.frames.resize(static_cast<std::size_t>(frames));
  return loop;
}

// The material moves by whole pixels; `fresh` is the amplitude of new noise in each frame.
void fill(LoopSample& loop, double kept, double fresh) {
  for (std::size_t f = 0; f < loop.frames.size(); ++f) {
    LoopFrame& frame = loop.frames[f];
    const int dx = static_cast<int>(f % 5), dy = static_cast<int>(2 * (f % 3));
    frame.image = {kSide, kSide, {}};
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        frame.image.pixels.push_back(static_cast<std::uint8_t>(
            std::lround(127.5 + 60 * (kept * grain(x - dx + 100, y - dy + 100, 0) +
                                      fresh * grain(x, y, static_cast<int>(f) + 1)))));
    for (std::size_t n = 0; n < loop.tracked.size(); ++n) {
      const double x_px = 30.5 + 20.0 * static_cast<double>(n) + dx, y_px = 80.5 + dy;
      frame.tracks_m.push_back({static_cast<float>((x_px - kSide / 2.0) * kBlockStep_m),
                                static_cast<float>(1e-5 * static_cast<double>(f)),
                                static_cast<float>(y_px * kBlockStep_m)});
    }
  }
}

TEST(DecorrelationLaw, MaterialThatKeepsItsGrainCorrelatesFully) {
  LoopSample loop = loopOf(12);
  fill(loop, 1, 0);
  const Decorrelation curve = decorrelationOf(loop);
  EXPECT_EQ(curve.blocks, 4);
  ASSERT_EQ(curve.lag_ms.size(), 7u);  // up to half the loop
  for (std::size_t lag = 0; lag < 7; ++lag) {
    EXPECT_DOUBLE_EQ(curve.lag_ms[lag], 20.0 * static_cast<double>(lag));
    EXPECT_NEAR(curve.correlation[lag], 1, 1e-3) << lag;  // float places
  }
  // Frame f is 0.01 f mm from the plane; the later frames of a lag are lag ... 11.
  EXPECT_NEAR(curve.out_of_plane_mm[4], 0.01 * (4 + 11) / 2, 1e-5);
}

// Independent parts of equal variance: rho = kept^2 / (kept^2 + fresh^2) at every lag but 0.
TEST(DecorrelationLaw, NewNoiseLowersTheCorrelationByItsShareOfTheVariance) {
  support::Largest off("correlation less its closed form", "");
  for (const auto& [kept, fresh] :
       {std::pair(0.8, 0.6), std::pair(0.6, 0.8), std::pair(0.0, 1.0)}) {
    LoopSample loop = loopOf(24);
    fill(loop, kept, fresh);
    const Decorrelation curve = decorrelationOf(loop);
    EXPECT_NEAR(curve.correlation[0], 1, 1e-9);
    // Standard error of one block's rho is at most 1 / sqrt(81); at least 12 x 4 pairs are
    // averaged, and neighbours share frames.
    for (std::size_t lag = 1; lag < curve.correlation.size(); ++lag)
      EXPECT_NEAR(off(curve.correlation[lag] - kept * kept), 0, 0.06) << lag;
  }
}

TEST(DecorrelationLaw, EqualAndOppositeAndConstantBlocks) {
  const std::vector<float> a{1, 2, 5, 3}, opposite{-2, -4, -10, -6}, constant(4, 7);
  EXPECT_DOUBLE_EQ(correlationOf(a, a), 1);
  EXPECT_DOUBLE_EQ(correlationOf(a, opposite), -1);
  EXPECT_DOUBLE_EQ(correlationOf(a, constant), 0);
}

TEST(DecorrelationLaw, PointsOutOfThePictureAreLeftOutWhileTheyAreThere) {
  LoopSample loop = loopOf(12);
  fill(loop, 1, 0);
  for (std::size_t f = 0; f < 12; ++f)
    for (std::size_t n = 0; n < 3; ++n) loop.frames[f].tracks_m[n].y = 0.05f;  // out of the plane
  for (std::size_t f = 6; f < 12; ++f) loop.frames[f].tracks_m[3].y = 0.05f;
  const Decorrelation curve = decorrelationOf(loop);
  ASSERT_EQ(curve.correlation.size(), 6u);  // no pair of frames 0 to 5 has lag 6
  for (const double correlation : curve.correlation) EXPECT_NEAR(correlation, 1, 1e-3);
  for (LoopFrame& frame : loop.frames) frame.tracks_m.clear();
  loop.tracked.clear();
  EXPECT_TRUE(decorrelationOf(loop).correlation.empty());
}

}  // namespace
}  // namespace echocine::dataset
