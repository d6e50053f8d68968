#pragma once
// Paths as pages and JSON show them: names, not where on somebody's disk they lie.

#include <filesystem>
#include <string>

namespace echocine {

// The last part of a path: "loop.dcm", of "a/b/" "b".
std::string shownName(const std::filesystem::path& path);

// A message without `folder` before its names, and without the folders of other absolute paths.
std::string withoutFolders(std::string text, const std::filesystem::path& folder);

}  // namespace echocine
