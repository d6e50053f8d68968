#pragma once
// Typed access to a TOML table. Every requested key becomes a known key; finish() rejects all
// others. Every error is a SceneError `file:line: key: fault, accepted values`.

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/nearest_word.h"
#include "core/vec3.h"
#include "scene/key_log.h"
#include "scene/number_range.h"
#include "scene/toml_value.h"

namespace echocine {

class TomlTable {
 public:
  // `name` is the file's name in messages.
  static TomlTable parse(std::string_view text, const std::string& name);
  ~TomlTable();
  TomlTable(TomlTable&&) noexcept;

  bool has(std::string_view key);
  SourcePlace place(
      std::string_view key) const;  // of the key, or of the table if the key is absent
  [[noreturn]] void fail(std::string_view key, const std::string& what) const;

  // Without a fallback the key is required.
  double number(std::string_view key, std::optional<double> fallback, NumberRange range);
  int integer(std::string_view key, std::optional<int> fallback, int lo, int hi);
  bool boolean(std::string_view key, bool fallback);
  std::string text(std::string_view key, std::optional<std::string> fallback = std::nullopt);
  Vec3d vector(std::string_view key, double most = std::numeric_limits<double>::max());

  // One of the words.
  std::string word(std::string_view key, std::string_view fallback,
                   const std::vector<std::string_view>& words);

  // For tables whose keys are the user's own names.
  std::vector<std::string> keys() const;  // in ascending order
  bool isTable(std::string_view key);
  TomlValue value(std::string_view key);                // one bool, number or string; required
  std::vector<TomlValue> values(std::string_view key);  // a list of them; required

  bool isListOfTables(std::string_view key);
  std::vector<std::string> texts(std::string_view key);  // a string or a list of strings
  std::vector<double> numbers(std::string_view key);     // [a, b, ...]
  std::vector<std::pair<double, double>> pairs(std::string_view key);  // [[a, b], ...]

  // name = whole number, ordered by name: { a = 1, b = 2 }.
  std::vector<std::pair<std::string, int>> namedIntegers(std::string_view key, int lo, int hi);

  // Sub-tables. Absent ones are empty, so their defaults apply.
  TomlTable table(std::string_view key);
  std::vector<TomlTable> tables(std::string_view key);                               // [[key]]
  std::vector<std::pair<std::string, TomlTable>> namedTables(std::string_view key);  // [key.name]

  // A valid key without effect under the other settings. finish() rejects it with these words:
  // "accepted only with tgc = "table"".
  void unused(std::string_view key, std::string_view accepted_with);

  // Rejects keys that were not requested, and names the nearest known one.
  void finish() const;

 private:
  void noteDefault(std::string_view key, KeyDefault value) const;
  std::string withoutNul(std::string_view key, std::string text) const;
  struct Node;
  explicit TomlTable(std::unique_ptr<Node> node);
  // Reports an absent required key, and a misspelt one in the table.
  [[noreturn]] void missing(std::string_view key, const std::string& accepted) const;
  std::unique_ptr<Node> node_;
};

}  // namespace echocine
