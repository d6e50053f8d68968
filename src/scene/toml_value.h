#pragma once
// Single values of TOML, and a document in which some are replaced.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace echocine {

using TomlValue = std::variant<bool, std::int64_t, double, std::string>;

// As TOML writes it: true, 3, 0.5, "word". Doubles have the fewest digits that give them back.
std::string tomlText(const TomlValue& value);

// The document with `values` put at their keys, "signal.gain_db", in place of what is there or
// beside it. Comments and the order of keys are lost. Throws SceneError where the text is not TOML
// or a key leads through something that is no table. `name` is what messages call the document.
std::string withValues(std::string_view text, const std::string& name,
                       const std::vector<std::pair<std::string, TomlValue>>& values);

}  // namespace echocine
