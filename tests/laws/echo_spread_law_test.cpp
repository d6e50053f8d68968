// How a loop's own spread of echoes is measured, and that models are not taken to be smaller for
// it.

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "core/parallel.h"
#include "echo/echo_spread.h"
#include "fit/model_discrepancy.h"
#include "support/drawn_heart.h"

namespace echocine::echo {
namespace {

using namespace support;

// Samples of beam space, line by line.
constexpr int kLines = 420, kSamples = 640;
constexpr double kFirst_rad = -0.73, kStep_rad = 2 * 0.73 / (kLines - 1);
constexpr double kAlong_m = kDepth_m / kSamples;

struct PlantedSpread {
  double along_m, across_rad;  // standard deviations of intensity
};

// A bell along and across, of weights that add up to 1 or, of amplitudes, whose squares do.
template <typename T>
void spreadOut(std::vector<T>& plane, double lines, double samples, bool amplitudes) {
  const auto pass = [&](double deviation, int count, int step, int others, int other_step) {
    const int reach = static_cast<int>(std::ceil(3.5 * deviation));
    std::vector<double> bell;
    double sum = 0;
    for (int i = -reach; i <= reach; ++i) {
      bell.push_back(std::exp(-i * i / (2 * deviation * deviation)));
      sum += amplitudes ? bell.back() * bell.back() : bell.back();
    }
    for (double& b : bell) b /= amplitudes ? std::sqrt(sum) : sum;
    std::vector<T> row(static_cast<std::size_t>(count));
    for (int o = 0; o < others; ++o) {
      T* const from = plane.data() + o * other_step;
      for (int i = 0; i < count; ++i) {
        T total{};
        for (int b = -reach; b <= reach; ++b)
          total += static_cast<T>(bell[static_cast<std::size_t>(b + reach)]) *
                   from[std::clamp(i + b, 0, count - 1) * step];
        row[static_cast<std::size_t>(i)] = total;
      }
      for (int i = 0; i < count; ++i) from[i * step] = row[static_cast<std::size_t>(i)];
    }
  };
  pass(samples, kSamples, 1, kLines, kSamples);
  pass(lines, kLines, kSamples, kSamples, 1);
}

// The phantom as a scanner of known spread shows it: intensities spread by a bell, speckle of the
// amplitudes that go with it (root 2 wider), a logarithm of 60 dB. Blood lies `contrast_db` below
// all else. Tissue's speckle stays, as it moves little; blood's is new in every frame.
EchoLoop scan(const Phantom& phantom, const PlantedSpread& spread, double contrast_db, int frames) {
  EchoLoop loop = draw(phantom, {}, 1, 1);
  constexpr int kWidth = 500, kHeight = 380;
  constexpr double kPixel_m = 0.4e-3;
  loop.video.width = kWidth, loop.video.height = kHeight;
  loop.metres_per_pixel = kPixel_m;
  loop.frames_per_beat = frames;
  loop.find.sector = {250, 2, kFirst_rad, -kFirst_rad, 6, 370};
  loop.overlay.assign(static_cast<std::size_t>(kWidth * kHeight), 0);
  loop.video.frames.assign(static_cast<std::size_t>(frames), {});
  const auto size = static_cast<std::size_t>(kLines * kSamples);
  const double lines = spread.across_rad / kStep_rad, samples = spread.along_m / kAlong_m;
  parallelBlocks(loop.video.frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      std::vector<float> intensity(size);
      std::vector<std::complex<float>> field(size);
      for (std::size_t at = 0; at < size; ++at) {
        const double angle = kFirst_rad + kStep_rad * static_cast<double>(at / kSamples),
                     r = kAlong_m * (static_cast<double>(at % kSamples) + 0.5);
        const bool blood = phantom.tissue(r * std::sin(angle), r * std::cos(angle),
                                          static_cast<double>(n) / frames) == 2;
        intensity[at] = blood ? static_cast<float>(std::pow(10, -contrast_db / 10)) : 1;
        const std::uint64_t seed = hashOf(at, blood ? n + 1 : 0, 7);
        field[at] = {static_cast<float>(normalFromHashes(hashOf(seed, 1, 0), hashOf(seed, 2, 0))),
                     static_cast<float>(normalFromHashes(hashOf(seed, 3, 0), hashOf(seed, 4, 0)))};
      }
      spreadOut(intensity, lines, samples, false);
      spreadOut(field, lines * std::sqrt(2.0), samples * std::sqrt(2.0), true);
      for (std::size_t at = 0; at < size; ++at)
        intensity[at] =
            200 + 255.0F / 60 * 10 * std::log10(intensity[at] * std::norm(field[at]) / 2 + 1e-6F);
      PixelPlane plane;
      for (int j = 0; j < kHeight; ++j)
        for (int i = 0; i < kWidth; ++i) {
          const double x = (i + 0.5 - 250) * kPixel_m, z = (j + 0.5 - 2) * kPixel_m;
          const double line = (std::atan2(x, z) - kFirst_rad) / kStep_rad,
                       sample = std::hypot(x, z) / kAlong_m - 0.5;
          const bool inside = line >= 0 && line <= kLines - 1 && sample >= 0 && sample < kSamples;
          const float grey =
              inside ? greyAt(intensity.data(), kSamples, kLines, sample + 0.5, line + 0.5) : 0;
          plane.push_back(static_cast<std::uint8_t>(std::clamp(grey, 0.0F, 255.0F)));
        }
      loop.video.frames[n] = std::move(plane);
    }
  });
  loop.video.coloured.assign(loop.overlay.size(), 0);
  return loop;
}

// Eq. 10 against the logarithm of a wall's spread edge itself, step by step.
TEST(CompareSpread, AnEdgeIsSeenWhereItsLogarithmHasItsMiddle) {
  for (const double contrast_db : {5.0, 12.0, 25.0, 40.0}) {
    const double least = std::pow(10, -contrast_db / 10);
    const auto grey = [&](double t) {
      return std::log(least + (1 - least) * 0.5 * (1 + std::erf(t / std::sqrt(2.0))));
    };
    double first = 0, all = 0;
    constexpr double kStep = 0.01;
    for (double t = -8; t < 8; t += kStep) {
      const double rise = grey(t + kStep) - grey(t);
      first += (t + kStep / 2) * rise, all += rise;
    }
    EXPECT_NEAR(edgeShiftPerWidth(contrast_db), -first / all, 0.01) << contrast_db;
  }
  EXPECT_NEAR(edgeShiftPerWidth(0.01), 0, 0.01);
}

// Along and across add as squares by the normal's direction, across in proportion to range.
TEST(CompareSpread, TheShiftFollowsTheNormal) {
  EchoSpread spread;
  spread.along_m = 0.4e-3, spread.across_rad = 0.009, spread.contrast_db = 25, spread.patches = 1;
  spread.prepare();
  const double k = edgeShiftPerWidth(25);
  EXPECT_NEAR(spread.shift(0.08, 1), k * 0.4e-3, 1e-9);
  EXPECT_NEAR(spread.shift(0.08, -1), k * 0.4e-3, 1e-9);
  EXPECT_NEAR(spread.shift(0.08, 0), k * 0.72e-3, 1e-9);
  EXPECT_NEAR(spread.shift(0.04, 0), k * 0.36e-3, 1e-9);
  EXPECT_NEAR(spread.shift(0.08, std::sqrt(0.5)), k * std::sqrt(0.5 * (0.16 + 0.5184)) * 1e-3,
              1e-9);
  EXPECT_EQ(EchoSpread{}.shift(0.08, 0.3), 0);
}

TEST(CompareSpread, ThePlantedSpreadIsMeasured) {
  withThreads(2, [] {
    for (const PlantedSpread planted :
         {PlantedSpread{0.45e-3, 0.007}, PlantedSpread{0.6e-3, 0.012}}) {
      const EchoSpread found = measureSpread(scan(Phantom{}, planted, 25, 2), 0.4e-3);
      std::printf("planted %.2f mm, %.4f rad, 25 dB; found %.2f mm, %.4f rad, %.0f dB\n",
                  1e3 * planted.along_m, planted.across_rad, 1e3 * found.along_m, found.across_rad,
                  found.contrast_db);
      EXPECT_NEAR(found.along_m, planted.along_m, 0.2 * planted.along_m);
      EXPECT_NEAR(found.across_rad, planted.across_rad, 0.2 * planted.across_rad);
      EXPECT_NEAR(found.contrast_db, 25, 6);
    }
  });
}

// The heart whose size is right is the best one, whatever the spread: edges that a display shows
// inside it are told from walls.
TEST(CompareSpread, SizesAreFoundWhateverTheSpread) {
  withThreads(2, [] {
    for (const PlantedSpread planted :
         {PlantedSpread{0.3e-3, 0.003}, PlantedSpread{0.6e-3, 0.012}}) {
      const ModelLoop right = Phantom{}.model();
      const EchoLoop loop = scan(Phantom{}, planted, 25, 10);
      const ModelDiscrepancy d(loop, fromTheStart(), right);
      double value[5];
      for (int i = 0; i < 5; ++i)
        value[i] =
            d.refine(Phantom{.grow_m = 1e-3 * (i - 2), .beat = 0.15}.model(), {{}}).discrepancy;
      int best = 1;
      for (int i = 1; i < 4; ++i)
        if (value[i] < value[best]) best = i;
      const double bend = value[best - 1] - 2 * value[best] + value[best + 1],
                   grown_mm = best - 2 + 0.5 * (value[best - 1] - value[best + 1]) / bend;
      const EchoSpread& spread = d.stack().spread();
      std::printf("spread %.1f mm, %.3f rad: best %+.2f mm, shifts %.2f to %.2f mm\n",
                  1e3 * planted.along_m, planted.across_rad, grown_mm, 1e3 * spread.shift(0.075, 1),
                  1e3 * spread.shift(0.075, 0));
      EXPECT_NEAR(grown_mm, 0, 0.5);  // of shifts of 0.4 to 1.3 mm
    }
  });
}

// Without speckle, or with speckle finer than pixels, nothing is made up.
TEST(CompareSpread, ALoopWithoutSpeckleHasNoSpread) {
  EchoLoop flat = draw(Phantom{}, {}, 1, 1);
  for (std::uint8_t& grey : flat.video.frames.front()) grey = 90;
  EXPECT_EQ(measureSpread(flat, 0.8e-3).patches, 0);
  EXPECT_EQ(measureSpread(flat, 0.8e-3).shift(0.08, 0), 0);
}

}  // namespace
}  // namespace echocine::echo
