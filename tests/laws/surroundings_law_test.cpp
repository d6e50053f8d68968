// What is around the heart: scatterers of chest wall and lung that are renewed, and clutter by the
// direction of the beam.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include "frame/plan_loop.h"
#include "frame/simulator.h"
#include "motion/heart/heart_scene.h"
#include "motion/surfaces/beam_to_axis.h"
#include "scene/role.h"
#include "signal/noise.h"
#include "support/plain_scene.h"

namespace echocine::surroundings_law {
namespace {

// Correlation of log intensities one beat apart, by role. The heart is at the same place then.
std::map<Role, double> oneBeatApart(double surroundings_s) {
  Scene scene = heart::heartScene(heart::parametersFrom({}), heart::View::a4c, 6, Look::clean);
  scene.speckle.surroundings_time_s = surroundings_s;
  scene.speckle.blood_time_s = 0;
  scene.probe.lines = 96;
  scene.probe.samples = 384;
  scene.acquisition.beats = 2;
  scene.output.channels = {Channel::structure};
  const double beat_s = 1 / scene.acquisition.heart_rate_hz;
  const Simulator simulator(std::move(scene));
  const Frame a = simulator.frame(0), b = simulator.frame(beat_s);
  struct Sums {
    double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  };
  std::map<Role, Sums> sums;
  for (std::size_t i = 0; i < a.greys.size(); ++i) {
    const std::uint32_t id = a.truth->sample_ids[i];
    const auto x = static_cast<double>(a.greys[i]), y = static_cast<double>(b.greys[i]);
    if (x <= 0 || y <= 0) continue;
    Sums& s = sums[id == 0 ? Role::none : roleOf(simulator.scene().structures[id - 1u])];
    s.n += 1, s.x += x, s.y += y, s.xx += x * x, s.yy += y * y, s.xy += x * y;
  }
  std::map<Role, double> correlation;
  for (const auto& [role, s] : sums)
    correlation[role] =
        (s.xy - s.x * s.y / s.n) / std::sqrt((s.xx - s.x * s.x / s.n) * (s.yy - s.y * s.y / s.n));
  return correlation;
}

// Law: tissue of the background is renewed, the heart's own is not. Without a time nothing is.
TEST(SurroundingsLaw, AreRenewedBesideAHeartThatIsNot) {
  const std::map<Role, double> kept = oneBeatApart(0), renewed = oneBeatApart(0.05);
  EXPECT_GT(kept.at(Role::none), 0.999);
  EXPECT_LT(renewed.at(Role::none), 0.8);
  EXPECT_GT(kept.at(Role::lv_wall), 0.999);
  EXPECT_GT(renewed.at(Role::lv_wall), 0.97);
}

// Law: the angle is that of the window, in any heart.
TEST(SurroundingsLaw, TheBeamIsAlongTheVentricleInApicalViewsAlone) {
  for (const double edv_ml : {80.0, 130.0, 200.0})
    for (const auto& [view, low, high] : {std::tuple(heart::View::a4c, 0.0, 0.1),
                                          {heart::View::a2c, 0.0, 0.1},
                                          {heart::View::a3c, 0.0, 0.1},
                                          {heart::View::plax, 0.85, 1.0},
                                          {heart::View::psax_mid, 0.85, 1.0}}) {
      const Scene scene =
          heart::heartScene(heart::parametersFrom({{"edv", edv_ml}}), view, 4, Look::paper);
      const double across = squaredSineToLongAxis(scene, MeshMotion(scene));
      EXPECT_GE(across, low) << edv_ml;
      EXPECT_LE(across, high) << edv_ml;
    }
}

// Law: the level of the clutter follows that angle; 0 dB leaves it.
TEST(SurroundingsLaw, ClutterIsWeakerInParasternalViews) {
  const auto windowOf = [](heart::View view, double parasternal_db) {
    Scene scene = heart::heartScene(heart::parametersFrom({}), view, 4, Look::scanner);
    scene.artefacts.clutter_parasternal_db = parasternal_db;
    return planLoop(scene, MeshMotion(scene)).effects.clutter_window_db;
  };
  EXPECT_EQ(windowOf(heart::View::plax, 0), 0);
  EXPECT_GT(windowOf(heart::View::a4c, -8), -0.8);
  EXPECT_LT(windowOf(heart::View::plax, -8), -6.8);
}

// Law: two fields a part f of the renewal time apart have the squared correlation cos^2(pi f / 2)
// where the first begins; after the whole time they are independent, and the mean power stays.
TEST(SurroundingsLaw, ClutterIsRenewedAsItsTimeSays) {
  constexpr int kSamples = 200;
  Scene scene = support::plainScene({support::medium("blood", 1000, 1540)});
  scene.probe.lines = 64;
  scene.probe.samples = kSamples;
  scene.artefacts.clutter_db = -10;
  scene.artefacts.clutter_length_m = 50e-3;
  scene.artefacts.clutter_time_s = 0.4;
  std::map<double, double> product, power;
  double first_power = 0;
  constexpr int kSeeds = 40;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    scene.artefacts.clutter_seed = seed;
    const NearFieldClutter clutter(scene);
    const auto lineAt = [&](double time_s) {
      std::pair<std::vector<float>, std::vector<float>> field{std::vector<float>(kSamples),
                                                              std::vector<float>(kSamples)};
      clutter.add(1, time_s, 3, field.first.data(), field.second.data());
      return field;
    };
    const auto first = lineAt(0.8);
    for (const double part : {0.0, 0.25, 0.5, 1.0, 1.7}) {
      const auto other = lineAt(0.8 + part * 0.4);
      for (std::size_t k = 0; k < std::size_t{kSamples}; ++k) {
        product[part] += static_cast<double>(first.first[k] * other.first[k] +
                                             first.second[k] * other.second[k]);
        power[part] += static_cast<double>(other.first[k] * other.first[k] +
                                           other.second[k] * other.second[k]);
      }
    }
    for (std::size_t k = 0; k < std::size_t{kSamples}; ++k)
      first_power +=
          static_cast<double>(first.first[k] * first.first[k] + first.second[k] * first.second[k]);
  }
  for (const auto& [part, sum] : product) {
    const double expected = part < 1 ? std::cos(0.5 * std::numbers::pi * part) : 0;
    EXPECT_NEAR(sum / std::sqrt(first_power * power[part]), expected, 0.1) << part;
    EXPECT_NEAR(power[part] / first_power, 1, 0.15) << part;
  }
}

// Law: fields in succession are independent also where the clutter reaches the last sample, so that
// the plane has no samples to spare, and where its grain is wide. Their blend then has the same
// power at all instants.
TEST(SurroundingsLaw, ClutterThatReachesTheLastSampleKeepsItsPower) {
  Scene scene = support::plainScene({support::medium("blood", 1000, 1540)});
  scene.probe.lines = 64;
  scene.probe.samples = 600;
  scene.artefacts.clutter_length_m = 1;
  scene.artefacts.clutter_time_s = 0.5;
  const auto samples = static_cast<std::size_t>(scene.probe.samples);
  for (int seed = 1; seed <= 12; ++seed) {
    scene.artefacts.clutter_seed = seed;
    const NearFieldClutter clutter(scene);
    const auto at = [&](double time_s) {
      std::vector<float> field;
      for (int line = 0; line < scene.probe.lines; ++line) {
        std::vector<float> real(samples), imaginary(samples);
        clutter.add(1, time_s, line, real.data(), imaginary.data());
        field.insert(field.end(), real.begin(), real.end());
        field.insert(field.end(), imaginary.begin(), imaginary.end());
      }
      return field;
    };
    for (int number = -3; number < 6; ++number) {
      const std::vector<float> one = at(0.5 * number), two = at(0.5 * (number + 1));
      double product = 0, first = 0, second = 0;
      for (std::size_t i = 0; i < one.size(); ++i) {
        product += static_cast<double>(one[i]) * static_cast<double>(two[i]);
        first += static_cast<double>(one[i]) * static_cast<double>(one[i]);
        second += static_cast<double>(two[i]) * static_cast<double>(two[i]);
      }
      EXPECT_LT(std::abs(product) / std::sqrt(first * second), 0.15) << seed << " " << number;
    }
  }
}

// Law: any accepted renewal time gives finite numbers.
TEST(SurroundingsLaw, ClutterThatIsRenewedAtOnceIsFinite) {
  Scene scene = support::plainScene({support::medium("blood", 1000, 1540)});
  scene.probe.samples = 64;
  for (const double time_s : {1e-300, 5e-324}) {
    scene.artefacts.clutter_time_s = time_s;
    const NearFieldClutter clutter(scene);
    double power = 0;
    for (const double now_s : {0.25, 0.5}) {
      std::vector<float> real(64), imaginary(64);
      clutter.add(1, now_s, 3, real.data(), imaginary.data());
      for (std::size_t k = 0; k < 64; ++k)
        power += static_cast<double>(real[k] * real[k] + imaginary[k] * imaginary[k]);
    }
    EXPECT_TRUE(std::isfinite(power)) << time_s;
    EXPECT_GT(power, 0) << time_s;
  }
}

}  // namespace
}  // namespace echocine::surroundings_law
