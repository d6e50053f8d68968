#pragma once
// Whole files in, whole files out.

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace echocine {

// The text of a file. Throws SceneError when it cannot be read or is larger than max_bytes.
std::string readTextFile(const std::filesystem::path& path, std::size_t max_bytes);

// Writes beside the target and renames, so that the target is either as before or whole.
// Throws JobError with the system's reason (disk full, no permission), the target untouched.
void writeFileWhole(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace echocine
