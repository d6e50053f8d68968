#pragma once
// Zip archives in memory: deterministic bytes.

#include <bit>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace echocine {

static_assert(std::endian::native == std::endian::little);

// Appends a text, or a number in little endian, to a file in memory.
inline void append(std::vector<std::byte>& to, std::string_view text) {
  const std::size_t begin = to.size();
  to.resize(begin + text.size());
  std::memcpy(to.data() + begin, text.data(), text.size());
}

template <typename T>
void append(std::vector<std::byte>& to, const T& value) {
  append(to, std::string_view(reinterpret_cast<const char*>(&value), sizeof value));
}

// One file of an archive.
struct ZipPart {
  std::string name;
  std::span<const std::byte> whole;   // uncompressed content
  std::span<const std::byte> packed;  // bytes to write: the content, plain or deflated
  bool deflated = false;              // by raw deflate (RFC 1951)
};

// A complete archive, with times of 1 January 1980. Throws JobError from 4 GiB on, the limit of the
// plain format.
std::vector<std::byte> zipBytes(std::span<const ZipPart> parts);

}  // namespace echocine
