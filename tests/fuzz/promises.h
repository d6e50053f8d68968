#pragma once
// What the targets share: the promise about refusals, and a file to hand to readers of files.

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/error.h"
#include "support/temp_folder.h"

namespace echocine::fuzz {

inline void promise(bool kept, const std::string& what) {
  if (!kept) throw std::logic_error(what);
}

// Runs act, which may refuse in words. True when it did not.
template <typename Act>
bool accepts(const Act& act) {
  try {
    act();
    return true;
  } catch (const SceneError& error) {
    promise(*error.what() != 0, "a refusal without a word");
  } catch (const JobError& error) {
    promise(*error.what() != 0, "a failure without a word");
  }
  return false;
}

// A folder of this process; run.sh has it in memory.
inline const std::filesystem::path& scratchFolder() {
  static const support::TempFolder folder;
  return folder.path();
}

inline std::filesystem::path scratchFile(const char* name, std::string_view bytes) {
  const std::filesystem::path file = scratchFolder() / name;
  std::ofstream(file, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file;
}

}  // namespace echocine::fuzz
