#pragma once
// Quartiles, and the Pareto front of settings.

#include <cstddef>
#include <vector>

namespace echocine {

// Quartiles by linear interpolation between order statistics (rank q (n - 1)); all 0 without
// values.
struct Quartiles {
  double median = 0, first_quartile = 0, third_quartile = 0;
};
Quartiles quartilesOf(std::vector<double> values);

// A point is on the Pareto front if no other point is at least as good in both coordinates and
// better in one; smaller is better. Equal points are treated equally. In the order of the points.
struct CostAndError {
  double cost = 0, error = 0;
};
std::vector<bool> paretoFront(const std::vector<CostAndError>& points);

}  // namespace echocine
