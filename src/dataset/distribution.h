#pragma once
// Distributions of a dataset's parameters: drawn by quantile functions, so a draw is one number
// between 0 and 1 from any source.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/toml_table.h"

namespace echocine::dataset {

// A whole number or any other; none if it is not a number.
std::optional<double> numberIn(const TomlValue& value);

struct Distribution {
  enum class Kind { constant, uniform, whole, normal, choice };
  Kind kind = Kind::constant;
  double low = 0, high = 0;      // except for constants and choices; whole numbers include both
  double mean = 0, sd = 1;       // of the normal before truncation at low and high
  std::vector<TomlValue> items;  // of a choice; a constant has one item
  std::vector<double> weights;   // of a choice; the sum is 1
  std::string source;            // reference, for built-in ones

  static Distribution constant(TomlValue value);
  static Distribution uniform(double low, double high);
  static Distribution normal(double mean, double sd, double low, double high);

  // The value below which a fraction u of all draws lies. Precondition: 0 < u < 1.
  TomlValue quantile(double u) const;
  bool varies() const { return kind != Kind::constant; }
  // Smallest and largest number, if all values are numbers.
  std::optional<std::pair<double, double>> range() const;
  std::string text() const;  // in the syntax of a spec
};

// table.key: a single value, or one of
//   { uniform = [LOW, HIGH] }                        any number between
//   { whole = [LOW, HIGH] }                          whole numbers, both ends included
//   { normal = [MEAN, SD], within = [LOW, HIGH] }    truncated, not clamped
//   { choice = [A, B, ...], weights = [...] }        weights sum to 1 or to 100; default: equal
// Throws SceneError naming the key and the accepted values.
Distribution readDistribution(TomlTable& table, std::string_view key);

// Normalises weights to a sum of 1. Throws SceneError if they are negative or sum to neither 1 nor
// 100.
void normaliseWeights(const TomlTable& table, std::string_view key, std::vector<double>& weights);

// Distribution function of the standard normal, and its inverse to the last digits.
double normalCumulative(double z);
double normalQuantile(double p);  // Precondition: 0 < p < 1

}  // namespace echocine::dataset
