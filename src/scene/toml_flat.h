#pragma once
// All values of a TOML text by their dotted keys, for comparisons.

#include <map>
#include <string>
#include <string_view>

namespace echocine {

// "signal.gain_db" -> "3.0". A list, also of tables, is one value. `name` is the file's name in
// messages. Throws SceneError if the text is not TOML.
std::map<std::string, std::string> flatValues(std::string_view text, const std::string& name);

}  // namespace echocine
