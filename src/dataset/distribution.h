#pragma once
// What a parameter of a dataset may be: drawn by its quantile function, so that a draw is one
// number between 0 and 1 wherever it comes from.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scene/toml_table.h"

namespace echocine::dataset {

// Of a whole number or any other; nothing of what is no number.
std::optional<double> numberIn(const TomlValue& value);

struct Distribution {
  enum class Kind { constant, uniform, whole, normal, choice };
  Kind kind = Kind::constant;
  double low = 0, high = 0;      // of all but constants and choices; whole numbers include both
  double mean = 0, sd = 1;       // of the normal before it is cut off at low and high
  std::vector<TomlValue> items;  // of a choice; the constant is the only one
  std::vector<double> weights;   // of a choice; they sum to 1
  std::string source;            // what it was taken from, for those built in

  static Distribution constant(TomlValue value);
  static Distribution uniform(double low, double high);
  static Distribution normal(double mean, double sd, double low, double high);

  // The value below which a share u of all draws lies. Precondition: 0 < u < 1.
  TomlValue quantile(double u) const;
  // The share of draws at or below x; of what is not a number the place in the list counts.
  double cumulative(double x) const;
  bool varies() const { return kind != Kind::constant; }
  // Smallest and largest number, where all that it gives are numbers.
  std::optional<std::pair<double, double>> range() const;
  std::string text() const;  // as a spec has it
};

// table.key: a value by itself, or one of
//   { uniform = [LOW, HIGH] }                        any number between
//   { whole = [LOW, HIGH] }                          whole numbers, both ends included
//   { normal = [MEAN, SD], within = [LOW, HIGH] }    cut off, not clamped
//   { choice = [A, B, ...], weights = [...] }        weights sum to 1 or to 100; left out: equal
// Throws SceneError naming the key and what is accepted.
Distribution readDistribution(TomlTable& table, std::string_view key);

// Makes weights sum to 1. Throws SceneError where they are negative or sum to neither 1 nor 100.
void normaliseWeights(const TomlTable& table, std::string_view key, std::vector<double>& weights);

// Distribution function of the standard normal, and its inverse to the last digits.
double normalCumulative(double z);
double normalQuantile(double p);  // Precondition: 0 < p < 1

}  // namespace echocine::dataset
