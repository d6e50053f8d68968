#include "scene/toml_flat.h"

#include <toml++/toml.h>

#include <sstream>

#include "scene/toml_table.h"

namespace echocine {

namespace {

void addValues(const toml::table& table, const std::string& prefix,
               std::map<std::string, std::string>& to) {
  for (const auto& [key, node] : table) {
    const std::string path = prefix + std::string(key.str());
    if (const toml::table* below = node.as_table()) {
      addValues(*below, path + ".", to);
      continue;
    }
    std::ostringstream text;
    node.visit([&](const auto& value) { text << value; });
    to[path] = text.str();
  }
}

}  // namespace

std::map<std::string, std::string> flatValues(std::string_view text, const std::string& name) {
  TomlTable::parse(text, name);  // refuses what is no TOML in the words of scenes
  std::map<std::string, std::string> values;
  addValues(toml::parse(text, name), "", values);
  return values;
}

}  // namespace echocine
