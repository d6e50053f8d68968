#pragma once
// Checks the header of an OpenEXR file before the library reads it: the library allocates what a
// header requests, and a header of a hundred bytes can request gigabytes.

#include <cstddef>
#include <filesystem>

namespace echocine {

// Ours have about 1 kB.
inline constexpr std::size_t kMaxHeaderBytes = 1 << 16;

// Does the file start with a header of the kind that ExrStack writes? One part of scan lines, only
// attributes of the same types, none larger than the file, a picture within the limits of a scene.
// False for an unreadable file.
bool hasPlainExrHeader(const std::filesystem::path& path);

}  // namespace echocine
