#include "scene/toml_edit.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include "core/error.h"
#include "scene/toml_table.h"

namespace echocine {

namespace {

// Positions of toml++ count lines and code points from 1.
std::size_t byteOf(std::string_view text, const toml::source_position& position) {
  std::size_t at = 0;
  for (toml::source_index line = 1; line < position.line; ++line)
    at = std::min(text.find('\n', at), text.size() - 1) + 1;
  const auto continues = [&](std::size_t i) {
    return i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80;
  };
  for (toml::source_index column = 1; column < position.column && at < text.size(); ++column) do
      ++at;
    while (continues(at));
  return at;
}

[[noreturn]] void refuse(const std::string& name, const std::string& key, const std::string& what) {
  throw SceneError(atPlace({name, 0, key}, what));
}

// A value alone, so that it cannot end the line and begin another key.
void refuseUnlessOneValue(const TomlEdit& edit, const std::string& name) {
  const toml::table parsed = [&] {
    try {
      return toml::parse("value = " + *edit.value + "\n");
    } catch (const toml::parse_error& error) {
      refuse(name, edit.key, fmt::format("not TOML: {}", error.description()));
    }
  }();
  if (parsed.size() != 1 || edit.value->find('\n') != std::string::npos ||
      edit.value->find('#') != std::string::npos)
    refuse(name, edit.key, "is not one value");
}

// From the start of the key's line to the end of its value's last line.
void removeLines(const toml::key& key, const toml::node& value, std::string& text) {
  const std::size_t from = byteOf(text, {key.source().begin.line, 1});
  const std::size_t last = byteOf(text, value.source().end);
  const std::size_t end = std::min(text.find('\n', last), text.size() - 1) + 1;
  text.erase(from, end - from);
}

// A key and its value between the braces of a table, with one comma.
void removeInline(const toml::key& key, const toml::node& value, std::string& text) {
  constexpr std::string_view kSpace = " \t";
  std::size_t from = byteOf(text, key.source().begin), end = byteOf(text, value.source().end);
  end = std::min(text.find_first_not_of(kSpace, end), text.size());
  if (end < text.size() && text[end] == ',') {
    end = std::min(text.find_first_not_of(kSpace, end + 1), text.size());
  } else {
    const std::size_t before = text.find_last_not_of(kSpace, from - 1);
    if (before != std::string::npos && text[before] == ',') from = before;
  }
  text.erase(from, end - from);
}

// Below the header of the table, or with a header of its own at the end.
void addKey(const toml::table& root, const std::string& table, const std::string& line,
            const std::string& key, const std::string& name, std::string& text) {
  if (table.empty()) {
    text.insert(0, line);
    return;
  }
  const toml::node* node = root.get(table);
  if (!node) {
    if (!text.empty() && text.back() != '\n') text += '\n';
    text += fmt::format("\n[{}]\n{}", table, line);
    return;
  }
  const std::size_t begin = byteOf(text, node->source().begin);
  if (!node->is_table() || begin >= text.size() || text[begin] != '[')
    refuse(name, key, fmt::format("cannot be added: [{}] has no header of its own", table));
  const std::size_t end = text.find('\n', begin);
  if (end == std::string::npos)
    text += '\n' + line;
  else
    text.insert(end + 1, line);
}

void apply(const TomlEdit& edit, const std::string& name, std::string& text) {
  if (edit.value) refuseUnlessOneValue(edit, name);
  const std::size_t dot = edit.key.find('.');
  const std::string table = dot == std::string::npos ? "" : edit.key.substr(0, dot);
  const std::string own = dot == std::string::npos ? edit.key : edit.key.substr(dot + 1);
  const toml::table root = toml::parse(text, name);
  const toml::table* parent = table.empty() ? &root : root[table].as_table();
  if (!table.empty() && root.contains(table) && !parent)
    refuse(name, edit.key, fmt::format("{} is not a table", table));
  if (parent)
    for (const auto& [key, value] : *parent) {
      if (key.str() != own) continue;
      if (!edit.value)
        return parent->is_inline() ? removeInline(key, value, text) : removeLines(key, value, text);
      const std::size_t from = byteOf(text, value.source().begin);
      text.replace(from, byteOf(text, value.source().end) - from, *edit.value);
      return;
    }
  if (edit.value)
    addKey(root, table, fmt::format("{} = {}\n", own, *edit.value), edit.key, name, text);
}

}  // namespace

std::string withEdits(std::string text, const std::vector<TomlEdit>& edits,
                      const std::string& name) {
  TomlTable::parse(text, name);  // refuses what is not TOML, or nested too deep
  for (const TomlEdit& edit : edits) apply(edit, name, text);
  return text;
}

}  // namespace echocine
