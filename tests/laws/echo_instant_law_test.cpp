// Look-ups between pictures and pixels of a loop: one place, eight places, and a blended picture.

#include <gtest/gtest.h>

#include <cmath>

#include "core/hash_random.h"
#include "echo/echo_stack.h"
#include "support/drawn_heart.h"

namespace echocine::echo {
namespace {

using namespace support;

constexpr BeatPlace kWhole{.pictures = {4}};
constexpr BeatPlace kBetween{.pictures = {4, 5}, .shares = {0.3f, 0.7f}};
constexpr BeatPlace kSpline{.pictures = {19, 0, 1}, .shares = {0.1f, 0.7f, 0.2f}};

const EchoStack& stackOnce() {
  static const EchoStack stack(draw(Phantom{}, {}, 20, 3), {.end_diastole = 0, .frames = 20}, 20,
                               0.15);
  return stack;
}

// Inside the sector, on its border, and far outside.
double placeOf(int i, int axis) {
  return 0.25 * (1.2 * uniformFromHash(hashOf(static_cast<std::size_t>(i), axis)) -
                 (axis == 0 ? 0.6 : 0.1));
}

void expectNear(const EchoStack::Sample& a, const EchoStack::Sample& b) {
  EXPECT_NEAR(a.grey, b.grey, 2e-3);
  EXPECT_NEAR(a.gx, b.gx, 1e-3);
  EXPECT_NEAR(a.gz, b.gz, 1e-3);
  EXPECT_NEAR(a.visible, b.visible, 1e-4);
}

// The sum of pictures by their shares, each by single look-ups.
TEST(EchoInstantLaw, AnInstantIsTheSumOfItsPictures) {
  for (const BeatPlace& place : {kBetween, kSpline}) {
    const EchoInstant instant = stackOnce().instant(place);
    for (int i = 0; i < 400; ++i) {
      const double x = placeOf(i, 0), z = placeOf(i, 1);
      EchoStack::Sample sum;
      for (int p = 0; p < 3; ++p) {
        if (!(place.shares[p] > 0)) continue;
        BeatPlace one;
        one.pictures[0] = place.pictures[p];
        const EchoStack::Sample s = stackOnce().instant(one).at(x, z);
        sum.grey += place.shares[p] * s.grey, sum.gx += place.shares[p] * s.gx;
        sum.gz += place.shares[p] * s.gz, sum.visible += place.shares[p] * s.visible;
      }
      expectNear(instant.at(x, z), sum);
    }
  }
}

TEST(EchoInstantLaw, EightPlacesAndABlendEqualSingleLookUps) {
  int seen = 0;
  for (const BeatPlace& place : {kWhole, kBetween, kSpline})
    for (const bool blended : {false, true}) {
      const EchoInstant sums = stackOnce().instant(place);
      EchoInstant instant = stackOnce().instant(place);
      if (blended) instant.blend();
      for (int first = 0; first < 800; first += static_cast<int>(kFloatLanes)) {
        Floats8 x, z;
        for (int lane = 0; lane < static_cast<int>(kFloatLanes); ++lane) {
          x[lane] = static_cast<float>(placeOf(first + lane, 0));
          z[lane] = static_cast<float>(placeOf(first + lane, 1));
        }
        const SampleLanes together = instant.at(x, z);
        for (std::size_t lane = 0; lane < kFloatLanes; ++lane) {
          const EchoStack::Sample single = sums.at(x[lane], z[lane]);
          expectNear(
              {together.grey[lane], together.gx[lane], together.gz[lane], together.visible[lane]},
              single);
          expectNear(instant.at(x[lane], z[lane]), single);
          seen += single.visible > 0 ? 1 : 0;
        }
      }
    }
  EXPECT_GT(seen, 500);
}

}  // namespace
}  // namespace echocine::echo
