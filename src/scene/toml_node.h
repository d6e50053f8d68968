#pragma once
// The implementation behind TomlTable; only its sources include this, which keeps toml++ out of all
// other files.

#include <toml++/toml.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "scene/key_log.h"
#include "scene/toml_table.h"

namespace echocine {

// The parsed document is shared by all tables of one file.
struct TomlTable::Node {
  std::shared_ptr<const toml::table> root;  // keeps `table` alive
  const toml::table* table = nullptr;       // null: not in the file
  std::string file;
  std::string path;  // "probe", for messages
  int line = 0;
  std::vector<std::string> known;
  std::map<std::string, std::string, std::less<>>
      unused;  // key -> condition under which it is accepted

  const toml::node* find(std::string_view key) {
    if (std::find(known.begin(), known.end(), key) == known.end()) known.emplace_back(key);
    const toml::node* value = table ? table->get(key) : nullptr;
    if (!value && KeyLog::wanted()) KeyLog::note(fullKey(key), {});
    return value;
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

// The type's name in messages: "a string".
const char* typeName(const toml::node& node);

}  // namespace echocine
