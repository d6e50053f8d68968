#pragma once
// The HTML, CSS and JavaScript files of this folder, embedded in the program.

#include <cstddef>
#include <string_view>

namespace echocine {

struct Asset {
  const char* name;
  const char *begin, *end;
};
extern const Asset kAssets[];
extern const std::size_t kAssetCount;

// A file's text by its name without folders. Precondition: CMakeLists.txt lists it.
std::string_view pageAsset(std::string_view name);

}  // namespace echocine
