#pragma once
// Copies of a file with one fault each.

#include <filesystem>
#include <fstream>
#include <string>

#include "core/hash_random.h"
#include "support/temp_folder.h"

namespace echocine::support {

inline void writeBytes(const std::filesystem::path& file, const std::string& bytes) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

// One flipped bit, a run of bytes of another value, or an end that is cut off.
inline std::string damaged(std::string bytes, std::uint64_t seed) {
  const auto drawn = [&](std::uint64_t n, std::size_t below) {
    return static_cast<std::size_t>(hashOf(seed, n) % below);
  };
  if (bytes.empty()) return bytes;
  const std::size_t at = drawn(1, bytes.size());
  if (seed % 3 == 0) {
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << drawn(2, 8)));
  } else if (seed % 3 == 1) {
    for (std::size_t i = at; i < std::min(bytes.size(), at + 1 + drawn(3, 16)); ++i)
      bytes[i] = static_cast<char>(drawn(4 + i, 256));
  } else {
    bytes.resize(at);
  }
  return bytes;
}

}  // namespace echocine::support
