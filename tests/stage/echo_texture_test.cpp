// Texture of pictures whose texture is known: grains of a known width, greys of a known
// distribution, edges of a known slope.

#include "texture/echo_texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/hash_random.h"

namespace echocine {
namespace {

constexpr int kSide = 240;
constexpr double kPixel_m = 0.25e-3;

// A picture that is lit all over but for a corner of each upper row, as a sector is; by pixel.
EchoPicture lit(const std::function<double(int, int)>& grey) {
  EchoPicture picture;
  picture.width = picture.height = kSide;
  picture.pixel_x_m = picture.pixel_y_m = kPixel_m;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const bool inside = std::abs(x - kSide / 2) <= 20 + y;
      picture.grey.push_back(inside ? static_cast<float>(std::max(grey(x, y), 1.0)) : 0.0f);
    }
  return picture;
}

// What is not lit has no label.
void label(EchoPicture& picture, const std::function<int(int)>& of_row) {
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const bool is_lit = picture.grey[picture.labels.size()] > 0;
      picture.labels.push_back(is_lit ? static_cast<std::uint8_t>(of_row(y)) : std::uint8_t{0});
    }
}

double white(int seed, int x, int y) {
  return std::sqrt(12.0) * (uniformFromHash(hashOf(seed, x, y)) - 0.5);
}

// White noise under a bell; its autocovariance is a bell of sqrt(2) the deviation. Unit variance.
double grainAt(int seed, int x, int y, double deviation) {
  const int reach = static_cast<int>(std::ceil(3 * deviation));
  double sum = 0, squares = 0;
  for (int j = -reach; j <= reach; ++j)
    for (int i = -reach; i <= reach; ++i) {
      const double tap = std::exp(-0.5 * (i * i + j * j) / (deviation * deviation));
      sum += tap * white(seed, x + i, y + j);
      squares += tap * tap;
    }
  return sum / std::sqrt(squares);
}

TEST(EchoTexture, OfAGrainTheCellsCorrelationsAndDeviationsAreItsOwn) {
  constexpr double kDeviation_px = 1.2, kContrast = 15;
  EchoPicture picture =
      lit([](int x, int y) { return 100 + kContrast * grainAt(1, x, y, kDeviation_px); });
  label(picture, [](int y) { return y < 60 ? 1 : y < 220 ? 2 : 3; });
  const RegionTexture region = regionTexture(picture);
  const double cell_mm =
      2 * std::sqrt(2 * std::log(2.0)) * std::sqrt(2.0) * kDeviation_px * 1e3 * kPixel_m;
  EXPECT_NEAR(region.cell_horizontal_mm, cell_mm, 0.05 * cell_mm);
  EXPECT_NEAR(region.cell_vertical_mm, cell_mm, 0.05 * cell_mm);
  EXPECT_NEAR(region.myocardial_detrended_std, kContrast, 0.05 * kContrast);
  EXPECT_NEAR(region.myocardium_grey, 100, 2);
  EXPECT_NEAR(region.residual_skew, 0, 0.1);
  const SectorTexture sector = sectorTexture(picture);
  EXPECT_NEAR(sector.detrended_std, kContrast, 0.05 * kContrast);
  for (const double lag_mm : {1.0, 2.0}) {
    const double u = lag_mm / (1e3 * kPixel_m * kDeviation_px), expected = std::exp(-0.25 * u * u);
    const std::size_t i = lag_mm == 1 ? 0 : 1;
    // Places between pixels are interpolated, which takes a little of the grain; the mean over
    // +-3 mm that is taken off leaves every correlation a little lower.
    EXPECT_NEAR(sector.radial[i], expected, 0.08) << lag_mm;
    EXPECT_NEAR(sector.tangential[i], expected, 0.08) << lag_mm;
  }
}

// Columns of grey 60, a cavity, and grey 110; above and below them nothing counts.
TEST(EchoTexture, WallsOnEitherSideAndTheNearFieldHaveTheirGreys) {
  const auto cavity = [](int x, int y) { return x >= 100 && x < 140 && y >= 100 && y < 200; };
  const auto columns = [](int y) { return y >= 130 && y < 170; };
  EchoPicture picture = lit([&](int x, int y) {
    return y < 60 ? 130.0 : !columns(y) ? 200.0 : cavity(x, y) ? 30.0 : x < 100 ? 60.0 : 110.0;
  });
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const bool is_lit = picture.grey[picture.labels.size()] > 0;
      const bool wall = std::abs(x - 120) < 60 && y >= 90 && y < 210;
      picture.labels.push_back(static_cast<std::uint8_t>(is_lit && cavity(x, y) ? 1
                                                         : is_lit && wall       ? 2
                                                                                : 0));
    }
  const RegionTexture region = regionTexture(picture);
  EXPECT_EQ(region.left_wall_grey, 60);
  EXPECT_EQ(region.right_wall_grey, 110);
  EXPECT_EQ(sectorTexture(picture).near_field_grey, 130);
}

// The logarithm of an exponential variable has a skew of -1.14 (log-Rayleigh speckle).
TEST(EchoTexture, TheSkewOfLogRayleighSpeckle) {
  EchoPicture picture = lit([](int x, int y) {
    return 150 + 8 * std::log(-std::log(1 - uniformFromHash(hashOf(3, x, y))));
  });
  label(picture, [](int) { return 2; });
  EXPECT_NEAR(regionTexture(picture).residual_skew, -1.1395, 0.05);
}

// Deviation grows by 12 greys per 100 from region to region.
TEST(EchoTexture, TheSlopeOfTheDeviationOverTheLevel) {
  const auto levelOf = [](int y) { return y < 60 ? 40.0 : y < 120 ? 90.0 : 180.0; };
  EchoPicture picture =
      lit([&](int x, int y) { return levelOf(y) + (2 + 0.12 * levelOf(y)) * white(5, x, y); });
  label(picture, [](int y) { return y < 60 ? 1 : y < 120 ? 3 : 2; });
  EXPECT_NEAR(regionTexture(picture).level_std_slope, 12, 1);
}

TEST(EchoTexture, ARampHasItsSlopeAndNoRidges) {
  const EchoPicture picture = lit([](int x, int) { return 60 + 0.5 * x; });
  const SectorTexture sector = sectorTexture(picture);
  EXPECT_NEAR(sector.gradient_p50, 0.5 / (1e3 * kPixel_m), 1e-3);
  EXPECT_NEAR(sector.gradient_p95, 0.5 / (1e3 * kPixel_m), 1e-3);
  EXPECT_EQ(sector.ridge_fraction, 0);
  EXPECT_EQ(sector.dark_fraction, 0);
}

// A bright line 0.5 mm thick every 15 mm: a ridge on its own pixels and the blur about them.
TEST(EchoTexture, BrightLinesAreRidges) {
  const EchoPicture lines = lit([](int, int y) { return y % 60 < 2 ? 250 : 40; });
  EXPECT_GT(sectorTexture(lines).ridge_fraction, 2.0 / 60 * 0.7);
  EXPECT_LT(sectorTexture(lines).ridge_fraction, 8.0 / 60);
  const EchoPicture stripes = lit([](int, int y) { return y % 60 < 30 ? 250 : 40; });
  EXPECT_EQ(sectorTexture(stripes).ridge_fraction, 0);  // wide: an edge, no ridge
}

TEST(EchoTexture, WithoutLabelsNothingIsSaidOfRegions) {
  const RegionTexture region = regionTexture(lit([](int, int) { return 50; }));
  EXPECT_TRUE(std::isnan(region.cavity_grey));
  EXPECT_TRUE(std::isnan(region.level_std_slope));
}

}  // namespace
}  // namespace echocine
