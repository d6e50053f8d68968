#pragma once
// The files that a run leaves.

#include <map>
#include <string>

#include "support/temp_folder.h"

namespace echocine::support {

// Name -> bytes of every file.
inline std::map<std::string, std::string> filesOf(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[entry.path().lexically_relative(folder).string()] = bytesOf(entry.path());
  return files;
}

// What must be the same in every run of the scene: name -> bytes of every file but manifest.json,
// which has times; report.html up to its times.
inline std::map<std::string, std::string> lastingFiles(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || entry.path().filename() == "manifest.json") continue;
    std::string bytes = bytesOf(entry.path());
    if (entry.path().filename() == "report.html") bytes.resize(bytes.find("\"measured\":"));
    files[entry.path().lexically_relative(folder).string()] = std::move(bytes);
  }
  return files;
}

}  // namespace echocine::support
