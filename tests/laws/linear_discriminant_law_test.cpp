// Fisher's discriminant and the area under a ROC curve against closed forms.

#include "metrics/linear_discriminant.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/hash_random.h"

namespace echocine {
namespace {

// Classes of n rows; features are independent, of variance 1, and class a is moved by `apart`.
std::vector<FeatureRow> rowsAt(const FeatureRow& apart, int n, std::uint64_t seed) {
  std::vector<FeatureRow> rows;
  for (int i = 0; i < n; ++i) {
    FeatureRow row;
    for (std::size_t k = 0; k < apart.size(); ++k)
      row.push_back(apart[k] + normalFromHashes(hashOf(seed, i, k, 0), hashOf(seed, i, k, 1)));
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<double> scoresOf(const LinearDiscriminant& classifier,
                             const std::vector<FeatureRow>& rows) {
  std::vector<double> scores;
  for (const FeatureRow& row : rows) scores.push_back(classifier.of(row));
  return scores;
}

TEST(AreaUnderCurve, IsTheShareOfPairsInOrder) {
  const std::vector<double> a{1, 3, 3}, b{0, 3, 5};
  EXPECT_DOUBLE_EQ(areaUnderCurve(a, b), (3 + 2 * 0.5) / 9.0);
  EXPECT_DOUBLE_EQ(areaUnderCurve(a, a), 0.5);
  EXPECT_DOUBLE_EQ(areaUnderCurve(a, b) + areaUnderCurve(b, a), 1);
}

// If both covariances are the identity, the weights are the difference of the means over 1 + 0.1.
TEST(LinearDiscriminant, WeightsAreTheDifferenceOfTheMeans) {
  const LinearDiscriminant classifier(rowsAt({1.5, 0, -0.7}, 20000, 1),
                                      rowsAt({0, 0, 0}, 20000, 2));
  EXPECT_NEAR(classifier.weights()[0], 1.5 / 1.1, 0.03);
  EXPECT_NEAR(classifier.weights()[1], 0, 0.03);
  EXPECT_NEAR(classifier.weights()[2], -0.7 / 1.1, 0.03);
}

// Normal classes at a distance d have the area Phi(d / sqrt(2)).
TEST(LinearDiscriminant, NewRowsHaveTheAreaOfNormalClasses) {
  for (const double d : {0.0, 0.5, 1.0, 2.0}) {
    const LinearDiscriminant classifier(rowsAt({0.8 * d, -0.6 * d}, 4000, 3),
                                        rowsAt({0, 0}, 4000, 4));
    const double area = areaUnderCurve(scoresOf(classifier, rowsAt({0.8 * d, -0.6 * d}, 4000, 5)),
                                       scoresOf(classifier, rowsAt({0, 0}, 4000, 6)));
    EXPECT_NEAR(area, 0.5 * std::erfc(-0.5 * d), 0.02) << d;
  }
}

// Units do not matter.
TEST(LinearDiscriminant, AScaledFeatureHasTheSameWeight) {
  std::vector<FeatureRow> a = rowsAt({1, 0.5}, 500, 7), b = rowsAt({0, 0}, 500, 8);
  const LinearDiscriminant plain(a, b);
  for (std::vector<FeatureRow>* rows : {&a, &b})
    for (FeatureRow& row : *rows) row[0] *= 1000;
  const LinearDiscriminant scaled(a, b);
  for (const std::size_t i : {0u, 1u})
    EXPECT_NEAR(scaled.weights()[i], plain.weights()[i], 1e-9) << i;
}

}  // namespace
}  // namespace echocine
