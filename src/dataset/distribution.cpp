#include "dataset/distribution.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace echocine::dataset {

namespace {

// The cut-off normal's share of the whole one below a value.
std::pair<double, double> kept(const Distribution& d) {
  return {normalCumulative((d.low - d.mean) / d.sd), normalCumulative((d.high - d.mean) / d.sd)};
}

std::size_t chosen(const std::vector<double>& weights, double u) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < weights.size(); ++i)
    if (u < (sum += weights[i])) return i;
  return weights.size() - 1;
}

std::string listOf(const std::vector<TomlValue>& items) {
  std::string list;
  for (const TomlValue& item : items) list += (list.empty() ? "" : ", ") + tomlText(item);
  return list;
}

}  // namespace

std::optional<double> numberIn(const TomlValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* whole = std::get_if<std::int64_t>(&value)) return static_cast<double>(*whole);
  return std::nullopt;
}

double normalCumulative(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

// By halving: the distribution function is exact to its last digits, and draws are few.
double normalQuantile(double p) {
  double low = -40, high = 40;
  if (p > 0.5) return -normalQuantile(1 - p);  // where the function has its digits
  for (int i = 0; i < 62; ++i) {
    const double middle = 0.5 * (low + high);
    (normalCumulative(middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Distribution Distribution::constant(TomlValue value) {
  Distribution d;
  d.items = {std::move(value)};
  return d;
}

Distribution Distribution::uniform(double low, double high) {
  Distribution d;
  d.kind = Kind::uniform;
  d.low = low;
  d.high = high;
  return d;
}

Distribution Distribution::normal(double mean, double sd, double low, double high) {
  Distribution d = uniform(low, high);
  d.kind = Kind::normal;
  d.mean = mean;
  d.sd = sd;
  return d;
}

TomlValue Distribution::quantile(double u) const {
  switch (kind) {
    case Kind::constant:
      return items.front();
    case Kind::uniform:
      return std::lerp(low, high, u);
    case Kind::whole:
      return static_cast<std::int64_t>(std::min(low + std::floor(u * (high - low + 1)), high));
    case Kind::normal: {
      const auto [below, to] = kept(*this);
      return std::clamp(mean + sd * normalQuantile(std::lerp(below, to, u)), low, high);
    }
    case Kind::choice:
      return items[chosen(weights, u)];
  }
  return items.front();
}

std::optional<std::pair<double, double>> Distribution::range() const {
  if (kind != Kind::constant && kind != Kind::choice) return std::pair(low, high);
  std::optional<std::pair<double, double>> range;
  for (const TomlValue& item : items) {
    const std::optional<double> number = numberIn(item);
    if (!number) return std::nullopt;
    if (!range) range.emplace(*number, *number);
    range = std::pair(std::min(range->first, *number), std::max(range->second, *number));
  }
  return range;
}

std::string Distribution::text() const {
  switch (kind) {
    case Kind::constant:
      return tomlText(items.front());
    case Kind::uniform:
      return fmt::format("{{ uniform = [{}, {}] }}", low, high);
    case Kind::whole:
      return fmt::format("{{ whole = [{}, {}] }}", low, high);
    case Kind::normal:
      return fmt::format("{{ normal = [{}, {}], within = [{}, {}] }}", mean, sd, low, high);
    case Kind::choice:
      return fmt::format("{{ choice = [{}], weights = [{}] }}", listOf(items),
                         fmt::format("{}", fmt::join(weights, ", ")));
  }
  return {};
}

}  // namespace echocine::dataset
