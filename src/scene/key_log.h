#pragma once
// Which keys a scene could have had: what the reader asked for and did not find, with its defaults.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>

namespace echocine {

// In the file's unit; nothing where a key has no default.
using KeyDefault = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

// While one lives, tables that this thread reads note their absent keys in it. The innermost
// counts.
class KeyLog {
 public:
  KeyLog();
  ~KeyLog();
  KeyLog(const KeyLog&) = delete;
  KeyLog& operator=(const KeyLog&) = delete;

  // By full key, "probe.lines". Entries of a list share their list's name, "structure.priority".
  const std::map<std::string, KeyDefault>& absent() const { return absent_; }

  static bool wanted();  // by anybody in this thread
  // A key is often first looked for and then read: the default that is known counts.
  static void note(const std::string& key, KeyDefault value);

 private:
  KeyLog* outer_;
  std::map<std::string, KeyDefault> absent_;
};

}  // namespace echocine
