#pragma once
// The header of an OpenEXR file, checked before the library sees it: its reader reserves what a
// header says, and a header of a hundred bytes may say gigabytes.

#include <cstddef>
#include <filesystem>

namespace echocine {

// Ours are of about 1 kB.
inline constexpr std::size_t kMaxHeaderBytes = 1 << 16;

// Whether the file begins with a header as ExrStack writes it: of one part of scan lines, only
// attributes of those types, none larger than the file, a picture no larger than a scene may have.
// False for a file that cannot be read.
bool hasPlainExrHeader(const std::filesystem::path& path);

}  // namespace echocine
