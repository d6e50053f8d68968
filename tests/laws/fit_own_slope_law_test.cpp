// The slope that a discrepancy has in own loops is subtracted from it.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <deque>

#include "core/parallel.h"
#include "fit/own_look.h"
#include "support/drawn_heart.h"

namespace echocine::fit {
namespace {

using namespace support;

TEST(FitOwnSlope, ASlopeIsAStraightLineThroughItsPlace) {
  ExpectedSlope slope({0.5, 120}, {0.4, -0.001});
  EXPECT_EQ(slope.of({0.5, 120}), 0);
  EXPECT_NEAR(slope.of({0.6, 140}), 0.04 - 0.02, 1e-15);
  EXPECT_NEAR(slope.of({0.4, 100}), -0.04 + 0.02, 1e-15);
  slope.scaleTo(0.25);
  EXPECT_NEAR(slope.of({0.6, 140}), 0.25 * (0.04 - 0.02), 1e-15);
  EXPECT_EQ(ExpectedSlope().of({0.6, 140}), 0);
}

// The beat and the size at which a quadratic through D in a loop has its minimum, one at a time.
struct Lowest {
  double beat = 0, grow_m = 0;
};
ModelLoop phantomOf(const std::vector<double>& values) {
  return Phantom{.grow_m = values[1], .beat = values[0]}.model();
}
const std::vector<double> kTrue{0.15, 0};
const std::vector<double> kSteps{0.03, 1e-3};

template <typename Value>
double lowestAlong(std::size_t unknown, const Value& value) {
  double f[3];
  for (int i = 0; i < 3; ++i) {
    std::vector<double> at = kTrue;
    at[unknown] += kSteps[unknown] * (i - 1);
    f[i] = value(at);
  }
  return kTrue[unknown] + kSteps[unknown] * 0.5 * (f[0] - f[2]) / (f[0] - 2 * f[1] + f[2]);
}

// The speckle of a drawn loop does not move with its walls, and D is a sum of ratios: its minimum
// is not at the true beat and size. That of D' is, in other loops of the same kind.
TEST(FitOwnSlope, TheCorrectedDiscrepancyIsLowestAtTheTruth) {
  withThreads(2, [] {
    const ModelLoop model = phantomOf(kTrue);
    const auto loopsOf = [&](std::uint64_t first, std::uint64_t end) {
      std::deque<ModelDiscrepancy> loops;
      for (std::uint64_t seed = first; seed < end; ++seed)
        loops.emplace_back(draw(Phantom{}, {}, 20, seed), fromTheStart(), model);
      return loops;
    };
    const std::deque<ModelDiscrepancy> own = loopsOf(1, 4), others = loopsOf(11, 15);
    OwnDiscrepancies pointers;
    for (const ModelDiscrepancy& one : own) pointers.push_back(&one);
    const ExpectedSlope slope =
        slopeIn(pointers,
                {std::array{kTrue[0] - kSteps[0], kTrue[0], kTrue[0] + kSteps[0]},
                 std::array{kTrue[1] - kSteps[1], kTrue[1], kTrue[1] + kSteps[1]}},
                phantomOf);
    Lowest plain, corrected;
    for (const ModelDiscrepancy& loop : others) {
      const ExpectedLook look = lookIn(pointers, model, loop, FitPose{});
      const auto at = [&](const std::vector<double>& values) {
        ModelLoop seen = phantomOf(values);
        look.applyTo(seen);
        return loop.refine(seen, {FitPose{}}).discrepancy;
      };
      const auto less = [&](const std::vector<double>& values) {
        return at(values) - slope.of(values);
      };
      const auto n = static_cast<double>(others.size());
      plain.beat += (lowestAlong(0, at) - kTrue[0]) / n;
      plain.grow_m += (lowestAlong(1, at) - kTrue[1]) / n;
      corrected.beat += (lowestAlong(0, less) - kTrue[0]) / n;
      corrected.grow_m += (lowestAlong(1, less) - kTrue[1]) / n;
    }
    std::printf("beat %+.4f, corrected %+.4f; size %+.3f, corrected %+.3f mm\n", plain.beat,
                corrected.beat, 1e3 * plain.grow_m, 1e3 * corrected.grow_m);
    EXPECT_GT(std::abs(plain.beat), 4 * std::abs(corrected.beat));
    EXPECT_LT(std::abs(corrected.beat), 0.003);
    EXPECT_LT(std::abs(corrected.grow_m), 0.05e-3);
  });
}

}  // namespace
}  // namespace echocine::fit
