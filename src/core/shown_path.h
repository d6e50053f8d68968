#pragma once
// Paths as shown in pages and JSON: names without folders of this machine.

#include <filesystem>
#include <string>

namespace echocine {

// The last part of a path: "loop.dcm"; for "a/b/" it is "b".
std::string shownName(const std::filesystem::path& path);

// A message without `folder` before names, and without the folders of other absolute paths.
std::string withoutFolders(std::string text, const std::filesystem::path& folder);

}  // namespace echocine
