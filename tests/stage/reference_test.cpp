// The loop's one reference intensity: a percentile of all samples, against a sort.

#include "signal/reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "scene/white_rule.h"
#include "support/plain_scene.h"

namespace echocine {
namespace {

// 100 samples from 0 to 100 mm: the near field is the first 15.
Probe referenceProbe() {
  Probe p = support::plainScene({support::medium("m", 1000, 1500)}).probe;
  p.min_depth_m = 0;
  p.max_depth_m = 0.1;
  p.lines = 50;
  p.samples = 100;
  return p;
}

std::vector<float> randomPlane(unsigned seed) {
  std::mt19937 engine(seed);
  std::vector<float> plane(5000);
  for (float& v : plane) v = std::exp(static_cast<float>(engine() % 40000) / 1000 - 30);
  return plane;
}

std::vector<float> farField(const std::vector<float>& plane) {
  std::vector<float> kept;
  for (std::size_t i = 0; i < plane.size(); ++i)
    if (i % 100 >= 15) kept.push_back(plane[i]);
  return kept;
}

TEST(Reference, IsThePercentileOfASortToATenthOfAPercent) {
  std::vector<float> all;
  IntensityHistogram histogram(referenceProbe());
  for (unsigned seed = 0; seed < 20; ++seed) {
    const std::vector<float> plane = randomPlane(seed), far = farField(plane);
    histogram.add(plane);
    all.insert(all.end(), far.begin(), far.end());
  }
  std::sort(all.begin(), all.end());
  for (const double percent : {1.0, 50.0, 90.0, 99.0, 99.5, 99.99, 100.0}) {
    const auto rank =
        static_cast<std::size_t>(std::ceil(percent / 100 * static_cast<double>(all.size()))) - 1;
    const double found = histogram.percentile(percent);
    EXPECT_GE(found, all[rank]) << percent;
    EXPECT_LE(found, all[rank] * 1.001) << percent;
  }
}

// The first 15 % of depth is bright for the probe's sake, not the heart's.
TEST(Reference, LeavesTheNearFieldOut) {
  std::vector<float> plane(5000, 1.0f);
  for (std::size_t i = 0; i < plane.size(); ++i)
    if (i % 100 < 15) plane[i] = 1e6f;
  IntensityHistogram histogram(referenceProbe());
  histogram.add(plane);
  EXPECT_NEAR(histogram.percentile(100), 1, 1e-3);
}

TEST(Reference, IsOneWhenNothingIsBright) {
  IntensityHistogram histogram(referenceProbe());
  EXPECT_EQ(histogram.percentile(99.5), 1);
  histogram.add(std::vector<float>(5000, 0.0f));
  EXPECT_EQ(histogram.percentile(99.5), 1);
}

TEST(Reference, IsThatOfTheBrightSamplesWhenMostAreDark) {
  std::vector<float> plane(5000, 0.0f);
  plane[97] = 0.125f;
  plane[98] = 0.25f;
  plane[99] = 0.5f;
  IntensityHistogram histogram(referenceProbe());
  histogram.add(plane);
  EXPECT_NEAR(histogram.percentile(50), 0.25, 2.5e-4);
}

// Frames are measured in parallel; the same loop must have the same white.
TEST(Reference, DoesNotDependOnTheOrderOfFrames) {
  IntensityHistogram forwards(referenceProbe()), backwards(referenceProbe());
  for (unsigned i = 0; i < 9; ++i) {
    forwards.add(randomPlane(i));
    backwards.add(randomPlane(8 - i));
  }
  EXPECT_EQ(forwards.percentile(97), backwards.percentile(97));
}

// A left ventricle in its wall: media are soft tissue, myocardium and blood.
Scene ventricle() {
  Scene scene = support::plainScene({support::medium("soft_tissue", 1000, 1540),
                                     support::medium("myocardium", 1060, 1540),
                                     support::medium("blood", 1060, 1540)});
  support::addStructure(scene, 1, 1);
  support::addStructure(scene, 2, 2);
  scene.structures[0].role = Role::lv_wall;
  scene.structures[1].role = Role::lv_cavity;
  scene.signal.reference_percentile = kWhiteByMuscle;
  scene.probe.lines = 100;
  scene.probe.samples = 100;
  return scene;
}

// Half of all samples tissue of 1, the others of the medium with this intensity.
double whiteWith(const Scene& scene, std::uint32_t medium, float intensity, std::size_t every = 2) {
  std::vector<float> plane(10'000, 1.0f);
  std::vector<std::uint32_t> media(plane.size(), 0);
  for (std::size_t i = 0; i < plane.size(); i += every) {
    plane[i] = intensity;
    media[i] = medium;
  }
  WhiteMeasure white(scene);
  white.add(plane, media);
  return white.white();
}

// Law: the muscle's median has kMuscleGrey, whatever is brighter beside it, with any dynamic range
// and grey map.
TEST(Reference, GivesMuscleItsGrey) {
  Scene scene = ventricle();
  for (const double gamma : {0.7, 1.0, 1.35})
    for (const double range_db : {40.0, 60.0, 90.0}) {
      scene.signal.grey_gamma = gamma;
      scene.signal.dynamic_range_db = range_db;
      const double below_db = 10 * std::log10(whiteWith(scene, 1, 2e-6f) / 2e-6);
      EXPECT_NEAR(255 * std::pow(1 - below_db / range_db, gamma), kMuscleGrey, 0.2);
    }
}

// Of a picture with dark blood in any share of it, from a seam to nearly all.
TEST(Reference, DoesNotDependOnHowMuchACavityFills) {
  const Scene scene = ventricle();
  const auto white = [&](std::size_t blood) {
    std::vector<float> plane(10'000);
    std::vector<std::uint32_t> media(plane.size());
    for (std::size_t i = 0; i < plane.size(); ++i) {
      const bool dark = i * 7919 % plane.size() < blood;
      plane[i] = (dark ? 1e-8f : 1e-5f) * static_cast<float>(1 + i % 10);
      media[i] = dark ? 2 : 1;
    }
    WhiteMeasure measure(scene);
    measure.add(plane, media);
    return measure.white();
  };
  const double wall_alone = white(0);
  for (const std::size_t blood : {500u, 3000u, 6000u, 9000u})
    EXPECT_NEAR(white(blood), wall_alone, 0.01 * wall_alone) << blood;
}

TEST(Reference, WithoutMuscleInViewIsThePercentile) {
  EXPECT_NEAR(whiteWith(ventricle(), 2, 2e-6f), 1, 1e-3);       // blood alone
  EXPECT_NEAR(whiteWith(ventricle(), 1, 2e-6f, 200), 1, 1e-3);  // a seam of muscle
  Scene given = ventricle();
  given.signal.reference_percentile = 40;  // names its own
  EXPECT_NEAR(whiteWith(given, 1, 2e-6f), 2e-6, 2e-9);
}

TEST(Reference, OnlyHeartsHaveMuscle) {
  const auto muscle = [](const Scene& scene) {
    const std::vector<char> media = muscleMedia(scene);
    return std::vector<int>(media.begin(), media.end());
  };
  Scene scene = ventricle();
  EXPECT_EQ(muscle(scene), (std::vector<int>{0, 1, 0}));
  scene.structures[0].role = Role::none;  // by its medium
  EXPECT_EQ(muscle(scene), (std::vector<int>{0, 1, 0}));
  scene.structures.erase(scene.structures.begin());  // chambers in the background
  EXPECT_EQ(muscle(scene), (std::vector<int>{1, 0, 0}));
  scene.structures[0].role = Role::none;  // no heart
  EXPECT_EQ(muscle(scene), (std::vector<int>{0, 0, 0}));
  EXPECT_FALSE(isWhiteByMuscle(scene));
}

}  // namespace
}  // namespace echocine
