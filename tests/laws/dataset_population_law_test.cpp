// Healthy hearts and infarcts of a dataset have the indices of the people they stand for.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "dataset/aim.h"
#include "dataset/index_draws.h"
#include "support/all_cases.h"
#include "support/ventricle_sections.h"

namespace echocine::dataset {
namespace {

using heart::IndexDials;
using heart::kIndexDialCount;

Spec populationSpec(const std::string& name, const std::string& rest = "") {
  return parseSpec(
      "hearts = 20\nviews = [\"a4c\"]\nseed = 4\n[populations]\n" + name + " = 1\n" + rest,
      "spec.toml");
}

double drawnNumber(const Values& values, const std::string& name) {
  return numberIn(values.at(name)).value();
}

IndexDials drawnIndices(const Values& values) {
  IndexDials dials{};
  for (std::size_t i = 0; i < kIndexDialCount; ++i)
    dials[i] = drawnNumber(values, std::string("heart.") + heart::kIndexDials[i]);
  return heart::indicesOf(dials, drawnNumber(values, "subject.body_surface_m2"));
}

// Sums of hearts, for their moments.
struct IndexSums {
  double count = 0;
  IndexDials sum{};
  std::array<IndexDials, kIndexDialCount> product{};

  void add(const IndexDials& x) {
    ++count;
    for (std::size_t i = 0; i < kIndexDialCount; ++i) {
      sum[i] += x[i];
      for (std::size_t j = 0; j < kIndexDialCount; ++j) product[i][j] += x[i] * x[j];
    }
  }
  double mean(std::size_t i) const { return sum[i] / count; }
  double covariance(std::size_t i, std::size_t j) const {
    return product[i][j] / count - mean(i) * mean(j);
  }
};

// 5,000 hearts by their dials: means within 0.1 SD of the table, SD within 5 %, correlations within
// 0.05.
TEST(DatasetPopulation, FiveThousandHeartsHaveTheTablesMoments) {
  constexpr int kHearts = 5000;
  for (const char* name : {"healthy", "infarct_lad", "infarct_rca", "infarct_lcx"}) {
    const Spec spec = populationSpec(name);
    const heart::HeartGroup& group = heart::heartGroups()[*spec.populations.front().group];
    IndexSums sums;
    for (int n = 0; n < kHearts; ++n) sums.add(drawnIndices(drawOf(spec, n, 0).values));
    for (std::size_t i = 0; i < kIndexDialCount; ++i) {
      const heart::HeartIndex row = heart::kIndexOfRow[i];
      const double sd = std::sqrt(sums.covariance(i, i));
      EXPECT_NEAR(sums.mean(i), group.mean[row], 0.1 * group.sd[row]) << name << ' ' << i;
      EXPECT_NEAR(sd, group.sd[row], 0.05 * group.sd[row]) << name << ' ' << i;
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_NEAR(sums.covariance(i, j) / sd / std::sqrt(sums.covariance(j, j)),
                    group.correlation[row * heart::kHeartIndices + heart::kIndexOfRow[j]], 0.05)
            << name << ' ' << i << ' ' << j;
    }
  }
}

// The hearts themselves: volume and ejection fraction of the cavity, the posterior wall, the long
// axis and its shortening, and the conicity, measured on the shape at end-diastole and at its
// smallest.
IndexDials measuredIndices(const heart::ParametricHeart& made, double body_surface_m2) {
  const heart::Parameters& p = made.parameters();
  const heart::Landmarks rest = made.landmarksAt(0);
  const double axis_m = length(rest.apex - rest.mitral);
  double least_m = axis_m;
  for (int i = 5; i < 14; ++i) {
    const heart::Landmarks now = made.landmarksAt(0.05 * i);
    least_m = std::min(least_m, length(now.apex - now.mitral));
  }
  const heart::LeftVentricle left(p);
  constexpr std::size_t kMidInferolateral = 10;  // segment 11
  return {p.edv_ml / body_surface_m2,
          100 * p.edv_ml * 1e-6 / (M_PI / 6 * std::pow(made.lvLength(), 3)),
          100 * p.ejection_fraction,
          200 * rest.wall_thickness_m[kMidInferolateral] / (p.sphericity * made.lvLength()),
          100 * (axis_m - least_m) / axis_m,
          100 * support::sectionDiameter(left, heart::kApicalHeight) /
              support::sectionDiameter(left, heart::kBasalHeight)};
}

// Each built heart has the indices of its dials; an infarct keeps its ejection fraction although
// segments of it do not move. The ventricles are possible: none is drawn again.
TEST(DatasetPopulation, BuiltHeartsHaveTheIndicesOfTheirDials) {
  const int hearts = support::allCases() ? 25 : 6;  // of each population
  constexpr IndexDials kTolerance{1e-6, 1e-3, 1e-6, 1.5, 1.0, 0.01};
  for (const char* name : {"healthy", "infarct_lad", "infarct_rca", "infarct_lcx"}) {
    const Spec spec = populationSpec(name);
    for (int n = 0; n < hearts; ++n) {
      const Values values = drawOf(spec, n, 0).values;
      const IndexDials wanted = drawnIndices(values),
                       measured = measuredIndices(modelOf(spec, values),
                                                  drawnNumber(values, "subject.body_surface_m2"));
      for (std::size_t i = 0; i < kIndexDialCount; ++i)
        EXPECT_NEAR(measured[i], wanted[i], kTolerance[i]) << name << ' ' << n << ' ' << i;
    }
  }
}

// The mean body surface is that of the sex. Values that the spec gives replace drawn ones.
TEST(DatasetPopulation, SexGivesBodySurfaceAndTheSpecGoesFirst) {
  const Spec women = populationSpec("healthy", "[subject]\nsex = \"F\"\n"),
             both = populationSpec("healthy"),
             fixed = populationSpec("infarct_rca",
                                    "[heart]\nmapse = 7\n[heart.segments.rca]\namplitude = 0.5\n");
  double surface_m2 = 0, women_of_both = 0;
  constexpr int kHearts = 1000;
  for (int n = 0; n < kHearts; ++n) {
    surface_m2 += drawnNumber(drawOf(women, n, 0).values, "subject.body_surface_m2") / kHearts;
    women_of_both += drawOf(both, n, 0).values.at("subject.sex") == TomlValue(std::string("F"));
  }
  EXPECT_NEAR(surface_m2, kWomenSurface_m2, 0.03);
  EXPECT_NEAR(women_of_both / kHearts, 0.5, 0.05);
  const Values values = drawOf(fixed, 0, 0).values;
  EXPECT_EQ(drawnNumber(values, "heart.mapse"), 7);
  EXPECT_EQ(drawnNumber(values, "heart.segments.rca.amplitude"), 0.5);
}

// Small infarcts leave a better ventricle: amplitude and ejection fraction rise together.
TEST(DatasetPopulation, AmplitudesFollowTheEjectionFraction) {
  const Spec spec = populationSpec("infarct_lad");
  double a = 0, e = 0, aa = 0, ee = 0, ae = 0;
  constexpr int kHearts = 2000;
  for (int n = 0; n < kHearts; ++n) {
    const Values values = drawOf(spec, n, 0).values;
    const double amplitude = drawnNumber(values, "heart.segments.lad.amplitude"),
                 ef = drawnNumber(values, "heart.ef");
    a += amplitude, e += ef, aa += amplitude * amplitude, ee += ef * ef, ae += amplitude * ef;
  }
  const double covariance = ae / kHearts - a * e / kHearts / kHearts,
               spread = std::sqrt((aa / kHearts - a * a / kHearts / kHearts) *
                                  (ee / kHearts - e * e / kHearts / kHearts));
  EXPECT_NEAR(covariance / spread, 0.8, 0.06);
}

}  // namespace
}  // namespace echocine::dataset
