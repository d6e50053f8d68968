#pragma once
// What holds of every random world, however it is traced.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>

#include "signal/signal_chain.h"
#include "support/random_world.h"

namespace echocine::support {

#if defined(NDEBUG)
inline constexpr std::uint64_t kScenes = 1000;
#elif defined(ECHOCINE_SANITIZED)
inline constexpr std::uint64_t kScenes = 200;
#else
inline constexpr std::uint64_t kScenes = 300;
#endif

inline std::uint64_t sceneCount() {
  const char* asked = std::getenv("ECHOCINE_RANDOM_SCENES");
  return asked ? std::strtoull(asked, nullptr, 10) : kScenes;
}

// Calls check(world) for every number, on one core, until three worlds have failed.
template <typename Check>
void forRandomWorlds(std::uint64_t count, Check&& check) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  double slowest_s = 0;
  int failed = 0;
  withThreads(1, [&] {
    for (std::uint64_t i = 0; i < count && failed < 3; ++i) {
      SCOPED_TRACE("random world " + std::to_string(i));
      const auto began = Clock::now();
      check(randomWorld(i), i);
      slowest_s = std::max(slowest_s, std::chrono::duration<double>(Clock::now() - began).count());
      const auto* result = testing::UnitTest::GetInstance()->current_test_info()->result();
      failed = result->total_part_count();
    }
  });
  EXPECT_LT(slowest_s, 60);  // seconds; they take milliseconds, so one that hangs shows
  std::printf("%llu random worlds in %.1f s, the slowest %.3f s\n",
              static_cast<unsigned long long>(count),
              std::chrono::duration<double>(Clock::now() - start).count(), slowest_s);
}

// The number of values that are no intensity.
inline std::size_t unusable(const std::vector<float>& values) {
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [](float v) {
    return !(v >= 0 && v <= std::numeric_limits<float>::max());
  }));
}

inline void expectIntensities(const World& world, const PolarFrame& polar) {
  for (const auto& [channel, plane] : polar.planes)
    EXPECT_EQ(unusable(plane), 0u) << channelName(channel);
  EXPECT_EQ(unusable(polar.intensities.values), 0u) << "signal";
  for (const std::uint32_t id : polar.medium)
    ASSERT_TRUE(id == kNoMedium || id < world.scene.media.size()) << id;
}

// Time gain, beam, compression and scan conversion of whatever was traced. The brightest sample is
// the reference: the loop's percentile has tests of its own and costs more than all the rest here.
inline void expectPicture(const World& world, const EffectPlan& plan, PolarFrame& polar) {
  const SignalChain chain(world.scene, plan);
  chain.process(polar.intensities);
  EXPECT_EQ(unusable(polar.intensities.values), 0u) << "after the signal chain";
  const double brightest = *std::max_element(polar.intensities.begin(), polar.intensities.end());
  const Greys greys = chain.compress(std::move(polar.intensities), brightest > 0 ? brightest : 1);
  for (const float grey : greys) ASSERT_TRUE(grey >= 0 && grey <= 1) << grey;
  GreyImage image;
  chain.picture(greys, image);
  EXPECT_EQ(image.pixels.size(), 24u * 20u);
}

}  // namespace echocine::support
