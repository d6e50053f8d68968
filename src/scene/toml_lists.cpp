// Values of a TOML table that are lists: vectors, numbers, pairs, texts, tables.

#include <fmt/format.h>

#include <cmath>

#include "scene/toml_node.h"

namespace echocine {

Vec3d TomlTable::vector(std::string_view key, double most) {
  const std::string accepted =
      most < std::numeric_limits<double>::max()
          ? fmt::format("accepted: three numbers [x, y, z] from {} to {}", -most, most)
          : "accepted: three finite numbers [x, y, z]";
  const toml::node* value = node_->find(key);
  if (!value) missing(key, accepted);
  const toml::array* list = value->as_array();
  if (!list || list->size() != 3) fail(key, fmt::format("is not a vector, {}", accepted));
  double xyz[3] = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::optional<double> number = (*list)[i].value<double>();
    if (!(*list)[i].is_number() || !number || !(std::abs(*number) <= most))
      fail(key,
           fmt::format("component {} is not a finite number within bounds, {}", i + 1, accepted));
    xyz[i] = *number;
  }
  return {xyz[0], xyz[1], xyz[2]};
}

namespace {

std::optional<TomlValue> scalarOf(const toml::node& node) {
  if (const auto word = node.value_exact<std::string>()) return TomlValue(*word);
  if (const auto truth = node.value_exact<bool>()) return TomlValue(*truth);
  if (const auto whole = node.value_exact<std::int64_t>()) return TomlValue(*whole);
  const auto number = node.value_exact<double>();
  if (number && std::isfinite(*number)) return TomlValue(*number);
  return std::nullopt;
}

}  // namespace

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> names;
  if (node_->table)
    for (const auto& [name, item] : *node_->table) names.emplace_back(name.str());
  return names;
}

bool TomlTable::isTable(std::string_view key) {
  const toml::node* value = node_->find(key);
  return value && value->is_table();
}

TomlValue TomlTable::value(std::string_view key) {
  const char* accepted = "accepted: a finite number, a string, true or false";
  const toml::node* value = node_->find(key);
  if (!value) missing(key, accepted);
  const std::optional<TomlValue> scalar = scalarOf(*value);
  if (!scalar) fail(key, fmt::format("is {}, {}", typeName(*value), accepted));
  return *scalar;
}

std::vector<TomlValue> TomlTable::values(std::string_view key) {
  const char* accepted = "accepted: a list of finite numbers, strings, true or false";
  const toml::node* value = node_->find(key);
  if (!value) missing(key, accepted);
  const toml::array* list = value->as_array();
  if (!list || list->empty()) fail(key, fmt::format("is {}, {}", typeName(*value), accepted));
  std::vector<TomlValue> result;
  for (const toml::node& item : *list) {
    const std::optional<TomlValue> scalar = scalarOf(item);
    if (!scalar)
      fail(key, fmt::format("entry {} has the wrong type, {}", result.size() + 1, accepted));
    result.push_back(*scalar);
  }
  return result;
}

bool TomlTable::isListOfTables(std::string_view key) {
  const toml::node* value = node_->find(key);
  return value && value->is_array() && !value->as_array()->empty() &&
         value->as_array()->front().is_table();
}

std::vector<std::string> TomlTable::texts(std::string_view key) {
  const toml::node* value = node_->find(key);
  if (!value) return {};
  if (value->is_string()) return {withoutNul(key, *value->value<std::string>())};
  const toml::array* list = value->as_array();
  if (!list)
    fail(key, fmt::format("is {}, accepted: a string or a list of strings", typeName(*value)));
  std::vector<std::string> result;
  for (const toml::node& item : *list) {
    if (!item.is_string()) fail(key, fmt::format("holds {}, accepted: strings", typeName(item)));
    result.push_back(withoutNul(key, *item.value<std::string>()));
  }
  return result;
}

std::vector<double> TomlTable::numbers(std::string_view key) {
  const char* accepted = "accepted: finite numbers [a, b, ...]";
  const toml::node* value = node_->find(key);
  if (!value) return {};
  const toml::array* list = value->as_array();
  if (!list) fail(key, fmt::format("is {}, {}", typeName(*value), accepted));
  std::vector<double> result;
  for (const toml::node& item : *list) {
    if (!item.is_number() || !std::isfinite(*item.value<double>()))
      fail(key, fmt::format("entry {} is not a finite number, {}", result.size() + 1, accepted));
    result.push_back(*item.value<double>());
  }
  return result;
}

std::vector<std::pair<double, double>> TomlTable::pairs(std::string_view key) {
  const char* accepted = "accepted: pairs of finite numbers [[a, b], [a, b], ...]";
  const toml::node* value = node_->find(key);
  if (!value) return {};
  const toml::array* list = value->as_array();
  if (!list) fail(key, fmt::format("is {}, {}", typeName(*value), accepted));
  std::vector<std::pair<double, double>> result;
  for (const toml::node& item : *list) {
    const toml::array* pair = item.as_array();
    if (!pair || pair->size() != 2 || !(*pair)[0].is_number() || !(*pair)[1].is_number())
      fail(key, fmt::format("entry {} is not a pair, {}", result.size() + 1, accepted));
    result.emplace_back(*(*pair)[0].value<double>(), *(*pair)[1].value<double>());
    if (!std::isfinite(result.back().first) || !std::isfinite(result.back().second))
      fail(key, fmt::format("entry {} is not finite, {}", result.size(), accepted));
  }
  return result;
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) {
  const toml::node* value = node_->find(key);
  if (!value) return {};
  const toml::array* list = value->as_array();
  std::vector<TomlTable> result;
  if (list)
    for (const toml::node& item : *list)
      if (item.is_table())
        result.push_back(TomlTable(node_->child(item.as_table(), node_->fullKey(key))));
  if (!list || result.size() != list->size())
    fail(key, fmt::format("is not a list of tables, accepted: [[{}]] tables", key));
  return result;
}

std::vector<std::pair<std::string, TomlTable>> TomlTable::namedTables(std::string_view key) {
  const toml::node* value = node_->find(key);
  if (!value) return {};
  if (!value->is_table())
    fail(key, fmt::format("is {}, accepted: [{}.name] tables", typeName(*value), key));
  std::vector<std::pair<std::string, TomlTable>> result;
  for (const auto& [name, item] : *value->as_table()) {
    const std::string path = node_->fullKey(key) + "." + std::string(name.str());
    if (!item.is_table())
      throw SceneError(atPlace({node_->file, static_cast<int>(item.source().begin.line), path},
                               fmt::format("is {}, accepted: a table", typeName(item))));
    result.emplace_back(std::string(name.str()), TomlTable(node_->child(item.as_table(), path)));
  }
  return result;
}

std::vector<std::pair<std::string, int>> TomlTable::namedIntegers(std::string_view key, int lo,
                                                                  int hi) {
  TomlTable names = table(key);
  std::vector<std::pair<std::string, int>> result;
  if (!names.node_->table) return result;
  for (const auto& [name, item] : *names.node_->table)
    result.emplace_back(std::string(name.str()), names.integer(name.str(), std::nullopt, lo, hi));
  return result;
}

}  // namespace echocine
