// The error measures of the study, against closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/hash_random.h"
#include "metrics/picture_error.h"

namespace echocine {
namespace {

constexpr int kWidth = 40, kHeight = 30;
constexpr double kRange_db = 60;

std::vector<float> plane(float value) {
  return std::vector<float>(kWidth * kHeight, value);
}

std::vector<float> noise(std::uint64_t seed) {
  std::vector<float> values = plane(0);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<float>(uniformFromHash(hashOf(seed, i)));
  return values;
}

GreyImage imageOf(const std::vector<float>& grey) {
  GreyImage image{kWidth, kHeight, {}};
  for (const float g : grey)
    image.pixels.push_back(static_cast<std::uint8_t>(std::lround(255 * std::max(g, 0.0f))));
  return image;
}

TEST(PictureErrorLaw, EqualPicturesHaveNone) {
  const std::vector<float> a = noise(1);
  const PictureError error = pictureError(a, a, kRange_db);
  EXPECT_EQ(error.rms_db, 0);
  EXPECT_EQ(error.max_db, 0);
  EXPECT_NEAR(structuralSimilarity(imageOf(a), imageOf(a), a), 1, 1e-12);
}

TEST(PictureErrorLaw, AnOffsetIsTheOffsetInDecibels) {
  std::vector<float> a = plane(0.5f), b = plane(0.55f);
  const PictureError error = pictureError(a, b, kRange_db);
  EXPECT_NEAR(error.rms_db, 3, 1e-5);
  EXPECT_NEAR(error.max_db, 3, 1e-5);
}

TEST(PictureErrorLaw, OnePixelOfNIsItsErrorOverTheRootOfN) {
  std::vector<float> a = plane(0.25f), b = a;
  b[7] = 0.75f;
  const PictureError error = pictureError(a, b, kRange_db);
  EXPECT_NEAR(error.max_db, 30, 1e-6);
  EXPECT_NEAR(error.rms_db, 30 / std::sqrt(1.0 * kWidth * kHeight), 1e-6);
}

TEST(PictureErrorLaw, SymmetricAndTheMaximumIsNotUnderTheRms) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<float> a = noise(2 * seed), b = noise(2 * seed + 1);
    const PictureError ab = pictureError(a, b, kRange_db), ba = pictureError(b, a, kRange_db);
    EXPECT_EQ(ab.rms_db, ba.rms_db);
    EXPECT_EQ(ab.max_db, ba.max_db);
    EXPECT_GE(ab.max_db, ab.rms_db);
    EXPECT_LE(ab.max_db, kRange_db);
    const double s = structuralSimilarity(imageOf(a), imageOf(b), a);
    EXPECT_NEAR(s, structuralSimilarity(imageOf(b), imageOf(a), a), 1e-12);
    EXPECT_LT(s, 1);
    EXPECT_GT(s, -1);
  }
}

TEST(PictureErrorLaw, OutsideTheSectorNothingCounts) {
  std::vector<float> a = plane(0.5f), b = plane(0.5f);
  a[3] = b[3] = -1;
  a[4] = -1;  // outside in one of them alone
  b[4] = 1;
  EXPECT_EQ(pictureError(a, b, kRange_db).max_db, 0);
  // An offset's mean is over the pixels inside.
  for (std::size_t i = 0; i < b.size(); i += 2) a[i] = 0.5f, b[i] = -1;
  for (std::size_t i = 1; i < b.size(); i += 2) b[i] = 0.55f;
  a[3] = 0.5f;
  EXPECT_NEAR(pictureError(a, b, kRange_db).rms_db, 3, 1e-5);
  std::vector<float> none = plane(-1);
  EXPECT_EQ(pictureError(none, b, kRange_db).rms_db, 0);
  GreyImage black = imageOf(plane(0)), white = imageOf(plane(1));
  EXPECT_EQ(structuralSimilarity(black, white, none), 1);
}

// Even pictures have no variance: SSIM is the term of the means alone.
TEST(StructuralSimilarity, OfEvenPicturesIsTheTermOfTheMeans) {
  const double c1 = 6.5025;
  for (const auto& [g, h] : {std::pair(0.0f, 1.0f), std::pair(0.2f, 0.6f), std::pair(0.4f, 0.4f)}) {
    const double x = std::lround(255 * g), y = std::lround(255 * h);
    EXPECT_NEAR(structuralSimilarity(imageOf(plane(g)), imageOf(plane(h)), plane(0)),
                (2 * x * y + c1) / (x * x + y * y + c1), 1e-9);
  }
}

// A picture and its negative about the same mean: the covariance is minus the variance.
TEST(StructuralSimilarity, OfANegativeIsNegativeWhereThereIsStructure) {
  std::vector<float> a = plane(0), b = a;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool odd = (i % kWidth + i / kWidth) % 2 == 1;
    a[i] = odd ? 1.0f : 0.0f;
    b[i] = odd ? 0.0f : 1.0f;
  }
  EXPECT_LT(structuralSimilarity(imageOf(a), imageOf(b), a), -0.95);
}

// By the definition itself, with the window's weights written out and summed in long double.
TEST(StructuralSimilarity, EqualsItsDefinitionInTheMiddleOfAPicture) {
  const std::vector<float> a = noise(5), b = noise(6);
  const GreyImage x = imageOf(a), y = imageOf(b);
  const int column = 20, row = 15;
  std::vector<float> only = plane(-1);
  only[row * kWidth + column] = 1;
  long double total = 0, mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
  for (int dy = -5; dy <= 5; ++dy)
    for (int dx = -5; dx <= 5; ++dx) {
      const long double w = std::exp(-(dx * dx + dy * dy) / (2 * 1.5L * 1.5L));
      const auto i = static_cast<std::size_t>((row + dy) * kWidth + column + dx);
      const long double p = x.pixels[i], q = y.pixels[i];
      total += w;
      mx += w * p;
      my += w * q;
      xx += w * p * p;
      yy += w * q * q;
      xy += w * p * q;
    }
  mx /= total;
  my /= total;
  const long double sx = xx / total - mx * mx, sy = yy / total - my * my,
                    sxy = xy / total - mx * my;
  const long double c1 = 6.5025L, c2 = 58.5225L;
  const long double expected =
      (2 * mx * my + c1) * (2 * sxy + c2) / ((mx * mx + my * my + c1) * (sx + sy + c2));
  EXPECT_NEAR(structuralSimilarity(x, y, only), static_cast<double>(expected), 1e-9);
}

}  // namespace
}  // namespace echocine
