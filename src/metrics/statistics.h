#pragma once
// Medians with their spread, and which settings no other one beats.

#include <cstddef>
#include <vector>

namespace echocine {

// Quartiles by linear interpolation between order statistics (rank q (n - 1)); all 0 of nothing.
struct Quartiles {
  double median = 0, first_quartile = 0, third_quartile = 0;
};
Quartiles quartilesOf(std::vector<double> values);

// A point is on the Pareto front when no other is at least as good in both coordinates and better
// in one; smaller is better. Equal points stand or fall together. In the order of the points.
struct CostAndError {
  double cost = 0, error = 0;
};
std::vector<bool> paretoFront(const std::vector<CostAndError>& points);

}  // namespace echocine
