// The spread of a fit over parts of its loops.

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/hash_random.h"
#include "core/parallel.h"
#include "fit/fit_resamples.h"
#include "support/drawn_heart.h"

namespace echocine::fit {
namespace {

using namespace support;

// The jackknife SD of a mean equals its standard error, s / sqrt(n).
TEST(FitResamples, OfAMeanItIsItsStandardError) {
  constexpr int kCount = 8;
  std::vector<double> numbers, without;
  double sum = 0, square = 0;
  for (int i = 0; i < kCount; ++i) {
    const auto n = static_cast<std::uint64_t>(i);
    numbers.push_back(normalFromHashes(hashOf(n, 1, 5), hashOf(n, 2, 5)));
    sum += numbers.back(), square += numbers.back() * numbers.back();
  }
  for (const double one : numbers) without.push_back((sum - one) / (kCount - 1));
  const double variance = (square - sum * sum / kCount) / (kCount - 1);
  EXPECT_NEAR(jackknifeSd(without), std::sqrt(variance / kCount), 1e-12);
  EXPECT_EQ(jackknifeSd({3, 3, 3, 3}), 0);
}

TEST(FitResamples, ACovarianceIsWidenedWithItsCorrelations) {
  std::vector<double> c{4, 1, 0.5, 1, 9, 0.3, 0.5, 0.3, 1};
  widenBy({4, 1}, c);  // twice the first SD, less than the second
  EXPECT_EQ(c, (std::vector<double>{16, 2, 1, 2, 9, 0.3, 1, 0.3, 1}));
}

// D without a block of pictures is that of the others alone: a change there changes nothing.
TEST(FitResamples, ABlockThatIsLeftOutDoesNotCount) {
  withThreads(2, [] {
    const ModelLoop model = Phantom{}.model();
    const ModelDiscrepancy d(draw(Phantom{}, {}, 20, 3), fromTheStart(), model);
    const ModelDiscrepancy part = d.without(4, 8);
    ModelLoop changed = model;
    for (std::size_t n = 4; n < 8; ++n) changed.frames[n] = model.frames[n - 4];
    EXPECT_NE(d.at(changed, {}).discrepancy, d.at(model, {}).discrepancy);
    EXPECT_EQ(part.at(changed, {}).discrepancy, part.at(model, {}).discrepancy);
    EXPECT_NE(part.at(model, {}).discrepancy, d.at(model, {}).discrepancy);
    EXPECT_NEAR(part.at(model, {}).discrepancy, d.at(model, {}).discrepancy, 0.05);
  });
}

TEST(FitResamples, NumbersOfBlocksAreChecked) {
  for (const int good : {0, kLeastResamples, kMostResamples}) checkResamples(good);
  for (const int bad : {-1, 1, kLeastResamples - 1, kMostResamples + 1})
    EXPECT_THROW(checkResamples(bad), SceneError);
}

}  // namespace
}  // namespace echocine::fit
