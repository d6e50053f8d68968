// Backscatter that differs from place to place: the laws of its field, of fibres, and of what
// scatterers make of it.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/hash_random.h"
#include "core/nearest_vertex.h"
#include "speckle/tissue_strength.h"
#include "support/meshes.h"
#include "support/speckle_bed.h"

namespace echocine {
namespace {

using namespace support;

Vec3f placeOf(int i) {
  const auto at = [&](std::uint64_t axis) {
    return static_cast<float>(0.2 * uniformFromHash(hashOf(i, axis)) - 0.1);
  };
  return {at(0), at(1), at(2)};
}

TEST(NormalField, HasVarianceOneEverywhereAndForgetsBeyondItsScale) {
  double sum = 0, squares = 0, near = 0, far = 0;
  constexpr int kPlaces = 40000;
  NormalField field(4e-3, 9);
  for (int i = 0; i < kPlaces; ++i) {
    const Vec3f p = placeOf(i);
    const double n = field.at(p);
    sum += n;
    squares += n * n;
    near += n * field.at(p + Vec3f{1e-4f, 0, 0});
    far += n * field.at(p + Vec3f{8.1e-3f, 0, 0});
  }
  EXPECT_NEAR(sum / kPlaces, 0, 0.03);
  EXPECT_NEAR(squares / kPlaces, 1, 0.04);
  EXPECT_GT(near / kPlaces, 0.95);
  EXPECT_NEAR(far / kPlaces, 0, 0.04);
}

// What it remembers of other places changes nothing.
TEST(NormalField, IsTheSameInAnyOrder) {
  NormalField used(4e-3, 9);
  for (int i = 0; i < 2000; ++i)
    for (const Vec3f p : {placeOf(i), 0.1f * placeOf(i)})
      EXPECT_EQ(used.at(p), NormalField(4e-3, 9).at(p)) << i;
}

// Law of the log-normal: mean 1, and the decibels' deviation is what was requested.
TEST(Heterogeneity, HasMeanOneAndItsDecibels) {
  SpeckleSettings settings;
  settings.heterogeneity_db = 4;
  double sum = 0, db = 0, db2 = 0;
  constexpr int kPlaces = 60000;
  Heterogeneity heterogeneity(settings, Probe{});
  for (int i = 0; i < kPlaces; ++i) {
    const double factor = heterogeneity.at(placeOf(i));
    sum += factor;
    const double d = 10 * std::log10(factor);
    db += d;
    db2 += d * d;
  }
  EXPECT_NEAR(sum / kPlaces, 1, 0.04);
  const double mean = db / kPlaces;
  EXPECT_NEAR(std::sqrt(db2 / kPlaces - mean * mean), 4, 0.1);
  EXPECT_NEAR(mean, -16 * std::numbers::ln10 / 20, 0.1);  // -s^2 / 2 in decibels
}

TEST(Fibres, TurnEvenlyFromARightHandedHelixToALeftHandedOne) {
  const Vec3d n{1, 0, 0}, a{0, 0, 1};
  for (const double depth : {0.0, 0.25, 0.5, 1.0}) {
    const Vec3d fibre = fibreAt(n, a, depth, radiansFromDegrees(60));
    const double h = radiansFromDegrees(60 - 120 * depth);
    EXPECT_NEAR(fibre.x, 0, 1e-15);
    EXPECT_NEAR(fibre.y, std::cos(h), 1e-15);  // right-handed round z at x
    EXPECT_NEAR(fibre.z, std::sin(h), 1e-15);
    EXPECT_NEAR(fibreFactor(fibre, a, 10), std::pow(10, -std::sin(h) * std::sin(h)), 1e-12);
  }
  EXPECT_EQ(fibreFactor({0, 1, 0}, {1, 0, 0}, 10), 1);
  EXPECT_NEAR(fibreFactor({0, -1, 0}, {0, 1, 0}, 10), 0.1, 1e-15);
}

TEST(NearestVertex, IsThatOfASearchThroughAll) {
  const Mesh ball = icosphere(3, 4).moved({1, -2, 7});
  std::vector<Vec3f> points_m;
  for (const Vec3d p : ball.points) points_m.push_back(toFloat(0.01 * p));
  const NearestVertex nearest(points_m);
  for (int i = 0; i < 500; ++i) {
    const Vec3f p = 1.5f * placeOf(i);
    float best = 1e9f;
    for (const Vec3f q : points_m) best = std::min(best, length(q - p));
    EXPECT_FLOAT_EQ(length(nearest.to(p) - p), best) << i;
  }
}

struct Weighted : OneGroup {
  bool differs() const override { return true; }
  void amplitudes(std::span<const Vec3f> reference_m, std::uint16_t,
                  std::span<float> out) const override {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = reference_m[i].z > 0.06f ? 0.5f : 1;
  }
};

// Law: the mean over seeds is the picture times the square of the scatterers' amplitudes.
TEST(Strength, ScalesTheMeanOfTheSpeckleAndNothingElse) {
  SpeckleBed bed(ProbeKind::phased, 48, 400, 0.04, 0.08);
  double whole = 0, half = 0;
  constexpr int kSeeds = 12;
  for (bed.settings.seed = 1; bed.settings.seed <= kSeeds; ++bed.settings.seed) {
    const Weighted weighted;
    const Speckle with(bed.probe, PointSpread(bed.probe, 2), bed.settings, weighted);
    const std::vector<float> picture = bed.picture(with), plain = bed.picture(bed.speckle());
    for (std::size_t i = 0; i < picture.size(); ++i) {
      const std::size_t k = i % 400;
      if (k < 180) {
        EXPECT_EQ(picture[i], plain[i]);
      }
      if (k < 180) whole += static_cast<double>(picture[i]) / (180 * 48 * kSeeds);
      if (k >= 220) half += static_cast<double>(picture[i]) / (180 * 48 * kSeeds);
    }
  }
  EXPECT_NEAR(whole, 1, 0.06);
  EXPECT_NEAR(half, 0.25, 0.02);
}

}  // namespace
}  // namespace echocine
