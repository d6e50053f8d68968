#pragma once
// Changes of single values in the text of a TOML file. Comments and layout are kept.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace echocine {

// A key, "probe.depth_mm" or "background" at the top, and its value as TOML; none removes the key.
struct TomlEdit {
  std::string key;
  std::optional<std::string> value;
};

// The text with the edits, in their order. A key that is absent is added below the header of its
// table, which is added at the end of the text if it does not exist. Removing an absent key changes
// nothing. `name` is the file's name in messages. Throws SceneError if the text or a value is not
// TOML, if the key is within a list of tables, or if its table has no header of its own.
std::string withEdits(std::string text, const std::vector<TomlEdit>& edits,
                      const std::string& name);

}  // namespace echocine
