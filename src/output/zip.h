#pragma once
// Zip archives in memory: the same bytes for the same parts.

#include <bit>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace echocine {

static_assert(std::endian::native == std::endian::little);

// A text, or a number as little endian has it, at the end of a file in the making.
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
  std::span<const std::byte> whole;   // what it holds
  std::span<const std::byte> packed;  // what is written: the whole itself, or that deflated
  bool deflated = false;              // by raw deflate (RFC 1951)
};

// A whole archive, its times 1 January 1980. Throws JobError from 4 GiB on, which the plain format
// cannot hold.
std::vector<std::byte> zipBytes(std::span<const ZipPart> parts);

}  // namespace echocine
