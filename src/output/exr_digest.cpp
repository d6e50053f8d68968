#include "output/exr_digest.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>
#include <optional>
#include <string_view>
#include <vector>

#include "core/check.h"
#include "core/digest.h"
#include "output/exr_header.h"

namespace echocine {

namespace {

// Blocks are multiples of the digest's stripes.
constexpr std::size_t kBlock = 1 << 18;

// Name 0, type 0, size as four bytes, lowest first: what stands before the digits. No other
// attribute of ours can hold the zeros.
std::string attributeStart() {
  std::string start(kExrDigestName);
  start += '\0';
  start += "string";
  start += '\0';
  start += static_cast<char>(Digest::kDigits);
  return start + std::string(3, '\0');
}

std::optional<std::size_t> placeOfDigits(std::span<const std::byte> bytes) {
  const std::string start = attributeStart();
  const std::string_view header(reinterpret_cast<const char*>(bytes.data()),
                                std::min(bytes.size(), kMaxHeaderBytes));
  const std::size_t at = header.find(start);
  if (at == std::string_view::npos || header.size() < at + start.size() + Digest::kDigits)
    return std::nullopt;
  return at + start.size();
}

}  // namespace

std::string emptyExrDigest() {
  return std::string(Digest::kDigits, '0');
}

void sealExr(std::span<std::byte> file) {
  const std::optional<std::size_t> at = placeOfDigits(file);
  CHECK_EQ(at.has_value(), true);
  Digest digest;
  digest.update(file);
  const std::string digits = digest.hex();
  std::memcpy(file.data() + *at, digits.data(), digits.size());
}

bool isSealedExr(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file && errno == ENOMEM) throw std::bad_alloc();
  std::vector<std::byte> block(kBlock);
  Digest digest;
  std::string digits;
  for (bool first = true; file; first = false) {
    file.read(reinterpret_cast<char*>(block.data()), static_cast<std::streamsize>(block.size()));
    const std::span<std::byte> bytes(block.data(), static_cast<std::size_t>(file.gcount()));
    if (first) {
      const std::optional<std::size_t> at = placeOfDigits(bytes);
      if (!at) return false;
      digits.assign(reinterpret_cast<const char*>(bytes.data()) + *at, Digest::kDigits);
      std::memset(bytes.data() + *at, '0', Digest::kDigits);
    }
    digest.update(bytes);
  }
  return !file.bad() && digest.hex() == digits;
}

}  // namespace echocine
