// Values shared by those who ask for equal keys, and the windows of the sampled beam among them.

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/recent_values.h"
#include "core/units.h"
#include "signal/profile_windows.h"
#include "support/plain_scene.h"

namespace echocine {
namespace {

struct CountedSquares {
  RecentValues<int, int> recent{2};
  int made = 0;
  std::shared_ptr<const int> of(int key) {
    return recent.get(key, [&] {
      ++made;
      return key * key;
    });
  }
};

TEST(RecentValuesLaw, EqualKeysShareAValue) {
  CountedSquares squares;
  const std::shared_ptr<const int> one = squares.of(7), two = squares.of(7);
  EXPECT_EQ(one, two);
  EXPECT_EQ(*one, 49);
  EXPECT_EQ(squares.made, 1);
}

TEST(RecentValuesLaw, TheLeastRecentlyUsedIsDropped) {
  CountedSquares squares;
  const std::weak_ptr<const int> one = squares.of(1), two = squares.of(2);
  squares.of(1);
  squares.of(3);
  EXPECT_FALSE(one.expired());
  EXPECT_TRUE(two.expired());
  EXPECT_EQ(*squares.of(2), 4);
  EXPECT_EQ(squares.made, 4);
}

TEST(RecentValuesLaw, AFailedValueIsMadeAgain) {
  RecentValues<int, int> recent(2);
  const auto fail = []() -> int { throw std::runtime_error("none"); };
  EXPECT_THROW(recent.get(1, fail), std::runtime_error);
  EXPECT_EQ(*recent.get(1, [] { return 5; }), 5);
}

TEST(RecentValuesLaw, ThreadsAtOnceGetOneValue) {
  constexpr int kThreads = 8, kRounds = 200;
  RecentValues<int, int> recent(2);
  std::vector<std::vector<std::shared_ptr<const int>>> got(kThreads);
  std::vector<std::thread> threads;
  for (auto& of_thread : got)
    threads.emplace_back([&] {
      for (int i = 0; i < kRounds; ++i) of_thread.push_back(recent.get(i / 100, [&] { return i; }));
    });
  for (std::thread& thread : threads) thread.join();
  for (const auto& of_thread : got)
    for (int i = 0; i < kRounds; ++i) EXPECT_EQ(of_thread[i], got[0][i / 100 * 100]);
}

Probe sharedProbe() {
  Probe probe = support::plainScene({support::medium("tissue", 1050, 1540)}).probe;
  probe.lines = 24;
  probe.samples = 64;
  return probe;
}

TEST(SharedWindowsLaw, AProbeHasThemWhereverItStands) {
  Probe probe = sharedProbe();
  const auto windows = sharedProfileWindows(probe, 2);
  probe.pose.origin = {0.01, 0.02, 0.03};
  probe.elevation_focus_m *= 2;
  EXPECT_EQ(sharedProfileWindows(probe, 2), windows);
  const ProfileWindows own(probe, 2);
  EXPECT_EQ(windows->weights, own.weights);
}

// Whatever changes weights makes windows of its own.
TEST(SharedWindowsLaw, AnotherProbeHasItsOwn) {
  const std::vector<std::function<void(Probe&)>> changes{
      [](Probe& p) { p.first_angle_rad *= 0.9; },
      [](Probe& p) { p.last_angle_rad *= 0.9; },
      [](Probe& p) { p.kind = ProbeKind::curvilinear, p.face_radius_m = 0.04; },
      [](Probe& p) { p.min_depth_m += 0.01; },
      [](Probe& p) { p.max_depth_m += 0.01; },
      [](Probe& p) { p.frequency_hz *= 1.5; },
      [](Probe& p) { p.aperture_m *= 1.5; },
      [](Probe& p) { p.focus_m *= 0.5; },
      [](Probe& p) { p.receive_apodization = Apodization::hann; },
      [](Probe& p) { p.bandwidth *= 0.5; },
      [](Probe& p) { p.lines += 1; },
      [](Probe& p) { p.samples *= 2; }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Probe probe = sharedProbe();
    const auto windows = sharedProfileWindows(probe, 2);
    changes[i](probe);
    const auto changed = sharedProfileWindows(probe, 2);
    EXPECT_NE(changed, windows) << i;
    const ProfileWindows own(probe, 2);
    EXPECT_EQ(changed->weights, own.weights) << i;
    EXPECT_EQ(changed->zones.size(), own.zones.size()) << i;
  }
  EXPECT_NE(sharedProfileWindows(sharedProbe(), 2), sharedProfileWindows(sharedProbe(), 3));
}

}  // namespace
}  // namespace echocine
