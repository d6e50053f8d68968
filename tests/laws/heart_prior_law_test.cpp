// The distribution of hearts before a loop: its table, its density and its draws.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/hash_random.h"
#include "fit/heart_prior.h"
#include "motion/heart/heart.h"
#include "motion/heart/wall_place.h"

namespace echocine::fit {
namespace {

const PriorDials kShippedDials{0.60, 120, 9, 0.60, 13, heart::outlineConicity()};

// The parametric heart has the indices that the formulas give its dials: the posterior wall, the
// long axis and its shortening are measured on its landmarks.
TEST(HeartPrior, IndicesAreThoseOfTheParametricHeart) {
  for (const PriorDials& d : {kShippedDials, PriorDials{0.40, 190, 10, 0.68, 8, 0.60},
                              PriorDials{0.65, 90, 8, 0.55, 14, 0.85}}) {
    const heart::ParametricHeart made(heart::parametersFrom({{"ef", d[kEf]},
                                                             {"edv", d[kEdv_ml]},
                                                             {"wall-thickness", d[kWall_mm]},
                                                             {"sphericity", d[kSphericity]},
                                                             {"mapse", d[kMapse_mm]},
                                                             {"conicity", d[kConicity]}}));
    const PriorDials x = indicesOf(d);
    const double axis = made.lvLength();
    const heart::Landmarks rest = made.landmarksAt(0);
    double least = 1;
    for (int i = 0; i < 40; ++i) {
      const heart::Landmarks now = made.landmarksAt(0.025 * i);
      least = std::min(least, length(now.apex - now.mitral));
    }
    const double base_to_apex = length(rest.apex - rest.mitral);
    EXPECT_NEAR(base_to_apex, axis, 0.02 * axis);
    EXPECT_NEAR(x[4], 100 * (base_to_apex - least) / base_to_apex, 1.0);
    EXPECT_NEAR(x[1], 100 * d[kEdv_ml] * 1e-6 / (M_PI / 6 * std::pow(axis, 3)), 1e-6);
    constexpr std::size_t kMidInferolateral = 10;  // segment 11
    EXPECT_NEAR(x[3], 200 * rest.wall_thickness_m[kMidInferolateral] / (d[kSphericity] * axis),
                1.0);
  }
}

// 5,000 draws of each group have the table's means within 0.1 SD, its SD within 5 % and its
// correlations within 0.05. Draws of the mixture have both groups in their shares.
TEST(HeartPrior, DrawsHaveTheTablesMoments) {
  const HeartPrior prior;
  constexpr int kDraws = 5000;
  for (std::size_t g = 0; g < 2; ++g) {
    const HeartGroup& group = heartGroups()[g];
    HeartIndices mean{};
    std::array<HeartIndices, kHeartIndices> square{};
    for (int n = 0; n < kDraws; ++n) {
      const HeartIndices x = prior.draw(g, 5, static_cast<std::uint64_t>(n));
      for (std::size_t i = 0; i < kHeartIndices; ++i) {
        mean[i] += x[i] / kDraws;
        for (std::size_t j = 0; j < kHeartIndices; ++j)
          square[i][j] += (x[i] - group.mean[i]) * (x[j] - group.mean[j]) / kDraws;
      }
    }
    for (std::size_t i = 0; i < kHeartIndices; ++i) {
      EXPECT_NEAR(mean[i], group.mean[i], 0.1 * group.sd[i]) << group.name << " " << i;
      EXPECT_NEAR(std::sqrt(square[i][i]), group.sd[i], 0.05 * group.sd[i]);
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_NEAR(square[i][j] / std::sqrt(square[i][i] * square[j][j]),
                    group.correlation[i * kHeartIndices + j], 0.05)
            << group.name << " " << i << " " << j;
    }
  }
  double ejection = 0;
  for (int n = 0; n < kDraws; ++n)
    ejection += prior.draw(5, static_cast<std::uint64_t>(n))[kEjectionIndex] / kDraws;
  EXPECT_NEAR(ejection, 0.5 * (62.9 + 41.3), 0.8);
}

TEST(HeartPrior, DrawsAreHashesOfSeedAndNumber) {
  const HeartPrior one, other;
  EXPECT_EQ(one.draw(3, 17), other.draw(3, 17));
  EXPECT_NE(one.draw(3, 17), one.draw(3, 18));
  EXPECT_NE(one.draw(3, 17), one.draw(4, 17));
}

TEST(HeartPrior, DialsAndIndicesAreInverse) {
  const HeartPrior prior;
  for (std::uint64_t n = 0; n < 200; ++n) {
    const HeartIndices drawn = prior.draw(9, n);
    const PriorDials x = indicesOf(HeartPrior::dialsOf(drawn));
    EXPECT_NEAR(x[0], drawn[kVolumeIndex], 1e-9);
    EXPECT_NEAR(x[1], drawn[kSphericityIndex], 1e-9);
    EXPECT_NEAR(x[2], drawn[kEjectionIndex], 1e-9);
    EXPECT_NEAR(x[3], drawn[kWallIndex], 1e-9);
    EXPECT_NEAR(x[4], drawn[kShorteningIndex], 1e-9);
    EXPECT_NEAR(x[5], drawn[kConicityIndex], 1e-9);
  }
}

// Against central differences, within 1e-6 of a prior SD's effect.
TEST(HeartPrior, TheGradientIsThatOfTheDensity) {
  const HeartPrior prior;
  for (const PriorDials& at : {kShippedDials, PriorDials{0.35, 200, 10, 0.70, 6, 0.62},
                               PriorDials{0.52, 150, 7, 0.55, 11, 0.88}}) {
    PriorDials slope{};
    const double here = prior.logDensity(at, &slope);
    EXPECT_EQ(here, prior.logDensity(at));
    for (std::size_t i = 0; i < kPriorDialCount; ++i) {
      const double step = 1e-4 * prior.sd()[i];
      PriorDials above = at, below = at;
      above[i] += step, below[i] -= step;
      const double difference = (prior.logDensity(above) - prior.logDensity(below)) / (2 * step);
      EXPECT_NEAR(slope[i] * prior.sd()[i], difference * prior.sd()[i], 1e-5) << kPriorDials[i];
    }
  }
}

// The integral of exp(logDensity) over the dials is 1: by importance sampling from the draws'
// moments, six normals of 1.5 SD.
TEST(HeartPrior, TheDensityIntegratesToOne) {
  const HeartPrior prior;
  constexpr int kPlaces = 400000;
  double sum = 0;
  for (int n = 0; n < kPlaces; ++n) {
    PriorDials at{};
    double weight = 1;
    bool inside = true;
    for (std::size_t i = 0; i < kPriorDialCount; ++i) {
      const double width = 1.5 * prior.sd()[i],
                   z = normalFromHashes(hashOf(n, i, 1), hashOf(n, i, 2));
      at[i] = prior.mean()[i] + width * z;
      weight *= width * std::sqrt(2 * M_PI) * std::exp(0.5 * z * z);
      // An excursion may be negative in the normal distribution: the apex rises alone.
      inside = inside && (at[i] > 0 || i == kMapse_mm);
    }
    if (inside) sum += weight * std::exp(prior.logDensity(at)) / kPlaces;
  }
  EXPECT_NEAR(sum, 1, 0.03);
}

// The default heart lies within 2.5 SD of the healthy mean in every index, and its density is
// above that of 95 of 100 draws' least.
TEST(HeartPrior, TheShippedHeartIsInside) {
  const HeartPrior prior;
  const PriorDials x = indicesOf(kShippedDials);
  const HeartGroup& healthy = heartGroups()[0];
  constexpr std::array kRows{kVolumeIndex, kSphericityIndex, kEjectionIndex,
                             kWallIndex,   kShorteningIndex, kConicityIndex};
  for (std::size_t i = 0; i < kRows.size(); ++i)
    EXPECT_LT(std::abs(x[i] - healthy.mean[kRows[i]]), 2.5 * healthy.sd[kRows[i]]) << i;
  int below = 0;
  const double shipped = prior.logDensity(kShippedDials);
  for (std::uint64_t n = 0; n < 1000; ++n)
    below += prior.logDensity(HeartPrior::dialsOf(prior.draw(8, n))) < shipped;
  std::printf("density above that of %d of 1000 draws; indices %.1f %.1f %.1f %.1f %.1f %.1f\n",
              below, x[0], x[1], x[2], x[3], x[4], x[5]);
  EXPECT_GT(below, 50);
}

}  // namespace
}  // namespace echocine::fit
