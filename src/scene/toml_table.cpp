#include "scene/toml_table.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "scene/toml_nesting.h"

namespace echocine {

namespace {

std::string quotedList(const std::vector<std::string_view>& names) {
  std::string text;
  for (std::string_view name : names)
    text += (text.empty() ? "\"" : " | \"") + std::string(name) + "\"";
  return text;
}

const char* typeName(const toml::node& node) {
  if (node.is_string()) return "a string";
  if (node.is_boolean()) return "a boolean";
  if (node.is_number()) return "a number";
  if (node.is_array()) return "a list";
  if (node.is_table()) return "a table";
  return "a date or time";
}

}  // namespace

bool NumberRange::contains(double value) const {
  return std::isfinite(value) && (lo_open ? value > lo : value >= lo) &&
         (hi_open ? value < hi : value <= hi);
}

std::string NumberRange::text() const {
  const bool has_lo = std::isfinite(lo), has_hi = std::isfinite(hi);
  if (!has_lo && !has_hi) return "a finite number";
  if (!has_hi)
    return fmt::format("a number {} {}", lo_open ? "over" : "from", lo) + (lo_open ? "" : " up");
  if (!has_lo) return fmt::format("a number {} {}", hi_open ? "under" : "up to", hi);
  return fmt::format("a number {} {} {} {}", lo_open ? "over" : "from", lo,
                     hi_open ? "and under" : "to", hi);
}

// The parsed document is shared by all tables of one file; the public header stays free of the
// library.
struct TomlTable::Node {
  std::shared_ptr<const toml::table> root;  // keeps `table` alive
  const toml::table* table = nullptr;       // null: absent in the file
  std::string file;
  std::string path;  // "probe", for messages
  int line = 0;
  std::vector<std::string> known;
  std::map<std::string, std::string, std::less<>> unused;  // key -> what it is accepted with

  const toml::node* find(std::string_view key) {
    if (std::find(known.begin(), known.end(), key) == known.end()) known.emplace_back(key);
    return table ? table->get(key) : nullptr;
  }
  std::string fullKey(std::string_view key) const {
    return path.empty() ? std::string(key) : path + "." + std::string(key);
  }
  std::unique_ptr<Node> child(const toml::table* t, std::string child_path) const {
    auto node = std::make_unique<Node>();
    node->root = root;
    node->table = t;
    node->file = file;
    node->path = std::move(child_path);
    node->line = t ? static_cast<int>(t->source().begin.line) : line;
    return node;
  }
};

TomlTable::TomlTable(std::unique_ptr<Node> node) : node_(std::move(node)) {}
TomlTable::~TomlTable() = default;
TomlTable::TomlTable(TomlTable&&) noexcept = default;

TomlTable TomlTable::parse(std::string_view text, const std::string& name) {
  auto node = std::make_unique<Node>();
  node->file = name;
  if (const int line = lineNestedTooDeep(text); line > 0)
    throw SceneError(atPlace(
        {name, line, ""}, fmt::format("keys, lists or tables are nested deeper than {}, which no "
                                      "scene needs",
                                      kMaxTomlNesting)));
  try {
    node->root = std::make_shared<const toml::table>(toml::parse(text, name));
  } catch (const toml::parse_error& error) {
    throw SceneError(atPlace({name, static_cast<int>(error.source().begin.line), ""},
                             fmt::format("not TOML: {}", error.description())));
  }
  node->table = node->root.get();
  return TomlTable(std::move(node));
}

void TomlTable::missing(std::string_view key, const std::string& accepted) const {
  if (node_->table)
    for (const auto& [name, value] : *node_->table) {
      const std::string word(name.str());
      const bool known =
          std::find(node_->known.begin(), node_->known.end(), word) != node_->known.end();
      if (known || nearestWord(word, {std::string(key)}, 3).empty()) continue;
      throw SceneError(
          atPlace({node_->file, static_cast<int>(name.source().begin.line), node_->fullKey(word)},
                  fmt::format("is not a known key here, and {} is missing, {}", key, accepted)));
    }
  fail(key, "is missing, " + accepted);
}

bool TomlTable::has(std::string_view key) {
  return node_->find(key) != nullptr;
}

SourcePlace TomlTable::place(std::string_view key) const {
  const toml::node* value = node_->table ? node_->table->get(key) : nullptr;
  const int line = value ? static_cast<int>(value->source().begin.line) : node_->line;
  return {node_->file, line, node_->fullKey(key)};
}

void TomlTable::fail(std::string_view key, const std::string& what) const {
  throw SceneError(atPlace(place(key), what));
}

double TomlTable::number(std::string_view key, std::optional<double> fallback, NumberRange range) {
  const toml::node* value = node_->find(key);
  if (!value) {
    if (!fallback) missing(key, "accepted: " + range.text());
    return *fallback;
  }
  const std::optional<double> number = value->value<double>();
  if (!value->is_number() || !number)
    fail(key, fmt::format("is {}, accepted: {}", typeName(*value), range.text()));
  if (!range.contains(*number))
    fail(key, fmt::format("is {}, accepted: {}", *number, range.text()));
  return *number;
}

int TomlTable::integer(std::string_view key, std::optional<int> fallback, int lo, int hi) {
  const std::string accepted = fmt::format("accepted: a whole number from {} to {}", lo, hi);
  const toml::node* value = node_->find(key);
  if (!value) {
    if (!fallback) missing(key, accepted);
    return *fallback;
  }
  const std::optional<std::int64_t> number = value->value_exact<std::int64_t>();
  if (!number) fail(key, fmt::format("is not a whole number, {}", accepted));
  if (*number < lo || *number > hi) fail(key, fmt::format("is {}, {}", *number, accepted));
  return static_cast<int>(*number);
}

bool TomlTable::boolean(std::string_view key, bool fallback) {
  const toml::node* value = node_->find(key);
  if (!value) return fallback;
  if (!value->is_boolean())
    fail(key, fmt::format("is {}, accepted: true | false", typeName(*value)));
  return *value->value<bool>();
}

std::string TomlTable::text(std::string_view key, std::optional<std::string> fallback) {
  const toml::node* value = node_->find(key);
  if (!value) {
    if (!fallback) missing(key, "accepted: a string");
    return *fallback;
  }
  if (!value->is_string()) fail(key, fmt::format("is {}, accepted: a string", typeName(*value)));
  return withoutNul(key, *value->value<std::string>());
}

// Names of files end at a NUL for the system, so that another file would be read than is named.
std::string TomlTable::withoutNul(std::string_view key, std::string text) const {
  if (text.find('\0') != std::string::npos)
    fail(key, "holds the character U+0000, accepted: text without it");
  return text;
}

std::optional<std::size_t> TomlTable::choiceIndex(std::string_view key,
                                                  const std::vector<std::string_view>& names) {
  const toml::node* value = node_->find(key);
  if (!value) return std::nullopt;
  const std::optional<std::string> word = value->value_exact<std::string>();
  if (!word) fail(key, fmt::format("is {}, accepted: {}", typeName(*value), quotedList(names)));
  const auto found = std::find(names.begin(), names.end(), *word);
  if (found == names.end())
    fail(key, fmt::format("is \"{}\", accepted: {}", *word, quotedList(names)));
  return static_cast<std::size_t>(found - names.begin());
}

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

TomlTable TomlTable::table(std::string_view key) {
  const toml::node* value = node_->find(key);
  if (value && !value->is_table())
    fail(key, fmt::format("is {}, accepted: a table", typeName(*value)));
  return TomlTable(node_->child(value ? value->as_table() : nullptr, node_->fullKey(key)));
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

void TomlTable::unused(std::string_view key, std::string_view accepted_with) {
  node_->unused.emplace(key, accepted_with);
}

void TomlTable::finish() const {
  if (!node_->table) return;
  for (const auto& [key, value] : *node_->table) {
    const std::string name(key.str());
    if (std::find(node_->known.begin(), node_->known.end(), name) != node_->known.end()) continue;
    if (const auto found = node_->unused.find(name); found != node_->unused.end())
      fail(name, "is a known key, but not used here, accepted only with " + found->second);
    const std::string nearest = nearestWord(name, node_->known);
    std::string accepted;
    for (const std::string& k : node_->known) accepted += (accepted.empty() ? "" : ", ") + k;
    throw SceneError(atPlace(
        {node_->file, static_cast<int>(key.source().begin.line), node_->fullKey(name)},
        nearest.empty()
            ? fmt::format("is not a known key here, accepted: {}", accepted)
            : fmt::format("is not a known key here, the nearest known one is {}", nearest)));
  }
}

}  // namespace echocine
