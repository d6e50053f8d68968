#include "scene/toml_value.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <sstream>

#include "scene/toml_node.h"

namespace echocine {

namespace {

struct Put {
  toml::table& table;
  std::string_view key;
  template <typename T>
  void operator()(const T& value) const {
    table.insert_or_assign(key, value);
  }
};

toml::table& tableAt(toml::table& table, std::string_view key, std::string_view whole,
                     const std::string& name) {
  toml::node& node = table.insert(key, toml::table{}).first->second;
  if (!node.is_table())
    throw SceneError(atPlace({name, 0, std::string(whole)},
                             fmt::format("{} is {}, accepted: a table", key, typeName(node))));
  return *node.as_table();
}

void put(toml::table& root, const std::string& key, const TomlValue& value,
         const std::string& name) {
  toml::table* table = &root;
  std::string_view rest = key;
  for (std::size_t dot; (dot = rest.find('.')) != std::string_view::npos;
       rest.remove_prefix(dot + 1))
    table = &tableAt(*table, rest.substr(0, dot), key, name);
  std::visit(Put{*table, rest}, value);
}

}  // namespace

std::string tomlText(const TomlValue& value) {
  std::ostringstream text;
  std::visit([&](const auto& v) { text << toml::value{v}; }, value);
  return text.str();
}

std::string withValues(std::string_view text, const std::string& name,
                       const std::vector<std::pair<std::string, TomlValue>>& values) {
  TomlTable::parse(text, name);  // refuses what is no TOML in the words of scenes
  toml::table root = toml::parse(text, name);
  for (const auto& [key, value] : values) put(root, key, value, name);
  std::ostringstream out;
  out << root << "\n";
  return out.str();
}

}  // namespace echocine
