#pragma once
// What stands behind a TomlTable; only its sources include this, so that nobody else meets toml++.

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
  const toml::table* table = nullptr;       // null: absent in the file
  std::string file;
  std::string path;  // "probe", for messages
  int line = 0;
  std::vector<std::string> known;
  std::map<std::string, std::string, std::less<>> unused;  // key -> what it is accepted with

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

// As messages call it: "a string".
const char* typeName(const toml::node& node);

}  // namespace echocine
