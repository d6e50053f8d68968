// Reverberations beyond the surface of lung, against closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "plan/media_in_use.h"
#include "signal/lung_echo.h"
#include "support/plain_scene.h"

namespace echocine::lung_echo_law {
namespace {

using namespace support;

constexpr int kLines = 24, kSamples = 300, kSurface = 90;
constexpr double kStep_m = 0.5e-3, kLength_m = 15e-3;

Scene lungScene(double level_db) {
  Scene scene = plainScene({medium("tissue", 1060, 1540), medium("lung", 400, 650)});
  scene.probe.lines = kLines;
  scene.probe.samples = kSamples;
  scene.probe.min_depth_m = 0;
  scene.probe.max_depth_m = kStep_m * kSamples;
  scene.artefacts.lung = true;
  scene.artefacts.lung_db = level_db;
  scene.artefacts.lung_length_m = kLength_m;
  return scene;
}

// Lung from kSurface on, in every line.
std::vector<std::uint32_t> media() {
  std::vector<std::uint32_t> ids(std::size_t{kLines} * kSamples);
  for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = i % kSamples >= kSurface ? 1 : 0;
  return ids;
}

std::vector<float> seen(const Scene& scene, std::vector<float> plane) {
  LungEcho(scene).add(media(), plane);
  return plane;
}

TEST(LungEchoLaw, ConstantTissueFadesExponentiallyWithoutAStep) {
  const Scene scene = lungScene(0);
  ASSERT_NEAR(scene.probe.sampleSpacing(), kStep_m, 1e-9);
  std::vector<float> plane(std::size_t{kLines} * kSamples);
  for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = i % kSamples < kSurface ? 3.0f : 0.0f;
  plane = seen(scene, plane);
  for (int k = 0; k < kSamples; ++k) {
    const double expected = k < kSurface ? 3 : 3 * std::exp(-(k - kSurface) * kStep_m / kLength_m);
    for (const int line : {0, kLines - 1})
      EXPECT_NEAR(plane[static_cast<std::size_t>(line * kSamples + k)], expected, 1e-5 * expected);
  }
}

// Twice the level, twice the echo; own backscatter of lung stays.
TEST(LungEchoLaw, AddsInProportionToLevelAndTissue) {
  std::vector<float> plane(std::size_t{kLines} * kSamples);
  for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = 1 + static_cast<float>(i * 7919 % 97);
  std::vector<float> tripled = plane;
  for (float& v : tripled) v *= 3;
  const std::vector<float> one = seen(lungScene(-10), plane), two = seen(lungScene(-7), plane),
                           three = seen(lungScene(-10), tripled);
  for (std::size_t i = 0; i < plane.size(); ++i) {
    const auto added = [&](const std::vector<float>& of) {
      return static_cast<double>(of[i]) - static_cast<double>(plane[i]);
    };
    if (i % kSamples < kSurface) {
      EXPECT_EQ(one[i], plane[i]);
      continue;
    }
    EXPECT_GT(added(one), 0);
    EXPECT_NEAR(added(two) / added(one), std::pow(10, 0.3), 1e-2);
    EXPECT_NEAR(three[i], 3 * one[i], 1e-4 * three[i]);
  }
}

// An echo s in front of the surface appears s beyond it, and the surface at twice its depth.
TEST(LungEchoLaw, MirrorsAnEchoAndRepeatsTheSurface) {
  constexpr int kBefore = 30;
  Scene scene = lungScene(0);
  scene.artefacts.lung_length_m = 10;  // no fade
  std::vector<float> plane(std::size_t{kLines} * kSamples);
  plane[kSurface - 1 - kBefore] = 1;
  plane = seen(scene, plane);
  double total = 0, moment = 0;
  for (int k = kSurface; k < 2 * kSurface; ++k) {
    const double v = plane[static_cast<std::size_t>(k)];
    total += v;
    moment += v * (k - kSurface);
  }
  // Blur w = 0.2 m spreads it over m(1 +- 0.2) = s: the mean of 1/(2 w) there is that of s/m.
  EXPECT_NEAR(total, std::log(1.2 / 0.8) / 0.4, 0.1);
  EXPECT_NEAR(moment / total, kBefore * (1 / 0.8 - 1 / 1.2) / std::log(1.2 / 0.8), 1.5);

  std::vector<float> surface(std::size_t{kLines} * kSamples);
  surface[kSurface - 1] = 1;
  surface = seen(scene, surface);
  const auto at = [&](int k) { return surface[static_cast<std::size_t>(k)]; };
  EXPECT_GT(at(3 * kSurface), 0);  // 2 D beyond the surface: the A-line
  EXPECT_EQ(at(2 * kSurface), 0);  // the face
}

TEST(LungEchoLaw, LeavesLinesWithoutLungAndAnyThreadsAlone) {
  const Scene scene = lungScene(0);
  std::vector<float> plane(std::size_t{kLines} * kSamples, 2.0f);
  std::vector<float> tissue = plane;
  LungEcho(scene).add(std::vector<std::uint32_t>(plane.size(), 0), tissue);
  EXPECT_EQ(tissue, plane);
  const std::vector<float> one = seen(scene, plane);
  withThreads(2, [&] { EXPECT_EQ(seen(scene, plane), one); });
  EXPECT_FALSE(holdsAir(scene));  // lung is not in use
  EXPECT_TRUE(isAirFilled(scene.media[1]));
  EXPECT_FALSE(isAirFilled(scene.media[0]));
}

}  // namespace
}  // namespace echocine::lung_echo_law
