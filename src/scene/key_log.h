#pragma once
// Keys that a scene could have had: those that the reader looked up and did not find, with
// defaults.

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <variant>

namespace echocine {

// In the file's unit; std::monostate for a key without default.
using KeyDefault = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

// During its lifetime, tables read by this thread record their absent keys in it. The innermost log
// is used.
class KeyLog {
 public:
  KeyLog();
  ~KeyLog();
  KeyLog(const KeyLog&) = delete;
  KeyLog& operator=(const KeyLog&) = delete;

  // By full key, "probe.lines". Entries of a list share their list's name, "structure.priority".
  const std::map<std::string, KeyDefault>& absent() const { return absent_; }

  static bool wanted();  // by any log of this thread
  // A key is often looked up before it is read. A known default replaces an unknown one.
  static void note(const std::string& key, KeyDefault value);

 private:
  KeyLog* outer_;
  std::map<std::string, KeyDefault> absent_;
};

}  // namespace echocine
