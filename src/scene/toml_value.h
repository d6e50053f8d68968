#pragma once
// Single TOML values, and a document with some values replaced.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace echocine {

using TomlValue = std::variant<bool, std::int64_t, double, std::string>;

// TOML syntax: true, 3, 0.5, "word". Doubles have the fewest digits that reproduce them.
std::string tomlText(const TomlValue& value);

// The document with `values` at their keys, such as "signal.gain_db", replacing or added to its
// own. Comments and the order of keys are lost. Throws SceneError if the text is not TOML or a key
// leads through a value that is not a table. `name` is the document's name in messages.
std::string withValues(std::string_view text, const std::string& name,
                       const std::vector<std::pair<std::string, TomlValue>>& values);

}  // namespace echocine
