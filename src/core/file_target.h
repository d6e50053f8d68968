#pragma once
// The folder of a file that is written, and the error if it cannot be. All writers share both.

#include <fmt/format.h>

#include <cstring>
#include <filesystem>

#include "core/error.h"

namespace echocine {

inline std::filesystem::path folderOf(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : ".";
}

// reason: of errno.
[[noreturn]] inline void failWriting(const std::filesystem::path& path, int reason) {
  throw JobError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(reason)));
}

}  // namespace echocine
