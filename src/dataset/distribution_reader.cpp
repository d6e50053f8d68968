#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "dataset/distribution.h"

namespace echocine::dataset {

namespace {

constexpr const char* kAccepted =
    "accepted: a value, { uniform = [LOW, HIGH] }, { whole = [LOW, HIGH] }, { normal = [MEAN, SD], "
    "within = [LOW, HIGH] } or { choice = [A, B], weights = [0.3, 0.7] }";

std::pair<double, double> readEnds(TomlTable& table, const char* key) {
  const std::vector<double> ends = table.numbers(key);
  if (ends.size() != 2 || !(ends[0] < ends[1]))
    table.fail(key, "is not a range, accepted: [LOW, HIGH] with LOW below HIGH");
  return {ends[0], ends[1]};
}

Distribution readNormal(TomlTable& table) {
  const std::vector<double> shape = table.numbers("normal");
  if (shape.size() != 2 || !(shape[1] > 0))
    table.fail("normal", "is not a normal distribution, accepted: [MEAN, SD] with SD above 0");
  if (!table.has("within"))
    table.fail("within",
               "is missing, accepted: [LOW, HIGH], where the normal distribution is truncated");
  const auto [low, high] = readEnds(table, "within");
  Distribution d = Distribution::normal(shape[0], shape[1], low, high);
  // Farther out the digits of the distribution function would show.
  constexpr double kFarthest = 6;
  if (low > d.mean + kFarthest * d.sd || high < d.mean - kFarthest * d.sd)
    table.fail(
        "within",
        fmt::format("lies over {} SD from the mean, where the normal distribution has no draws: "
                    "move the range or the mean",
                    kFarthest));
  return d;
}

Distribution readWhole(TomlTable& table) {
  const auto [low, high] = readEnds(table, "whole");
  if (low != std::floor(low) || high != std::floor(high))
    table.fail("whole", "is not a range of whole numbers, accepted: such as [1, 6]");
  Distribution d = Distribution::uniform(low, high);
  d.kind = Distribution::Kind::whole;
  return d;
}

Distribution readChoice(TomlTable& table) {
  Distribution d;
  d.kind = Distribution::Kind::choice;
  d.items = table.values("choice");
  d.weights = table.numbers("weights");
  if (d.weights.empty()) d.weights.assign(d.items.size(), 1 / static_cast<double>(d.items.size()));
  if (d.weights.size() != d.items.size())
    table.fail("weights", fmt::format("are {}, accepted: {}, one for each entry of choice",
                                      d.weights.size(), d.items.size()));
  normaliseWeights(table, "weights", d.weights);
  return d;
}

}  // namespace

void normaliseWeights(const TomlTable& table, std::string_view key, std::vector<double>& weights) {
  for (const double weight : weights)
    if (!(weight >= 0)) table.fail(key, fmt::format("hold {}, accepted: from 0 up", weight));
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  constexpr double kRounding = 1e-6;
  const bool shares = std::abs(sum - 1) <= kRounding;
  if (!shares && !(std::abs(sum - 100) <= 100 * kRounding))
    table.fail(key, fmt::format("sum to {:g}, accepted: weights that sum to 1, or to 100", sum));
  for (double& weight : weights) weight /= sum;
}

Distribution readDistribution(TomlTable& table, std::string_view key) {
  if (!table.isTable(key)) return Distribution::constant(table.value(key));
  TomlTable kinds = table.table(key);
  const int given =
      kinds.has("uniform") + kinds.has("whole") + kinds.has("normal") + kinds.has("choice");
  if (given != 1) table.fail(key, fmt::format("names {} distributions, {}", given, kAccepted));
  Distribution d;
  if (kinds.has("normal"))
    d = readNormal(kinds);
  else if (kinds.has("whole"))
    d = readWhole(kinds);
  else if (kinds.has("choice"))
    d = readChoice(kinds);
  else {
    const auto [low, high] = readEnds(kinds, "uniform");
    d = Distribution::uniform(low, high);
  }
  kinds.finish();
  return d;
}

}  // namespace echocine::dataset
