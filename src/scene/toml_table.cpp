#include "scene/toml_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/key_log.h"
#include "scene/toml_nesting.h"
#include "scene/toml_node.h"

namespace echocine {

namespace {

std::string quotedList(const std::vector<std::string_view>& names) {
  std::string text;
  for (std::string_view name : names)
    text += (text.empty() ? "\"" : " | \"") + std::string(name) + "\"";
  return text;
}

}  // namespace

const char* typeName(const toml::node& node) {
  if (node.is_string()) return "a string";
  if (node.is_boolean()) return "a boolean";
  if (node.is_number()) return "a number";
  if (node.is_array()) return "a list";
  if (node.is_table()) return "a table";
  return "a date or time";
}

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

void TomlTable::noteDefault(std::string_view key, KeyDefault value) const {
  if (KeyLog::wanted()) KeyLog::note(node_->fullKey(key), std::move(value));
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
    noteDefault(key, *fallback);
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
    noteDefault(key, std::int64_t{*fallback});
    return *fallback;
  }
  const std::optional<std::int64_t> number = value->value_exact<std::int64_t>();
  if (!number) fail(key, fmt::format("is not a whole number, {}", accepted));
  if (*number < lo || *number > hi) fail(key, fmt::format("is {}, {}", *number, accepted));
  return static_cast<int>(*number);
}

bool TomlTable::boolean(std::string_view key, bool fallback) {
  const toml::node* value = node_->find(key);
  if (!value) {
    noteDefault(key, fallback);
    return fallback;
  }
  if (!value->is_boolean())
    fail(key, fmt::format("is {}, accepted: true | false", typeName(*value)));
  return *value->value<bool>();
}

std::string TomlTable::text(std::string_view key, std::optional<std::string> fallback) {
  const toml::node* value = node_->find(key);
  if (!value) {
    if (!fallback) missing(key, "accepted: a string");
    noteDefault(key, *fallback);
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

std::string TomlTable::word(std::string_view key, std::string_view fallback,
                            const std::vector<std::string_view>& words) {
  const toml::node* value = node_->find(key);
  if (!value) {
    noteDefault(key, std::string(fallback));
    return std::string(fallback);
  }
  const std::optional<std::string> word = value->value_exact<std::string>();
  if (!word) fail(key, fmt::format("is {}, accepted: {}", typeName(*value), quotedList(words)));
  if (std::find(words.begin(), words.end(), *word) == words.end())
    fail(key, fmt::format("is \"{}\", accepted: {}", *word, quotedList(words)));
  return *word;
}

TomlTable TomlTable::table(std::string_view key) {
  const toml::node* value = node_->find(key);
  if (value && !value->is_table())
    fail(key, fmt::format("is {}, accepted: a table", typeName(*value)));
  return TomlTable(node_->child(value ? value->as_table() : nullptr, node_->fullKey(key)));
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
