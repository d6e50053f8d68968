#pragma once
// Fisher's linear discriminant of two classes of measurements, and the area under a ROC curve.

#include <span>
#include <vector>

namespace echocine {

using FeatureRow = std::vector<double>;  // the features of one picture

// Weights w = S^-1 (m_a - m_b) on features divided by their standard deviation within a class. m
// are the means of the classes, S is the mean of their covariances plus 0.1 on its unit diagonal:
// few rows, dependent features (our choice).
class LinearDiscriminant {
 public:
  // Preconditions: neither class is empty; all rows have the same number of finite features.
  LinearDiscriminant(std::span<const FeatureRow> a, std::span<const FeatureRow> b);

  double of(const FeatureRow& row) const;  // larger: more like class a
  const FeatureRow& weights() const { return weights_; }

 private:
  FeatureRow scale_, weights_;
};

// The mean of each feature. Precondition: not empty.
FeatureRow meanOf(std::span<const FeatureRow> rows);

// Share of pairs with a score of a above one of b; equal scores count half. 0.5: the scores do not
// separate the classes. Precondition: neither is empty.
double areaUnderCurve(std::span<const double> a, std::span<const double> b);

}  // namespace echocine
