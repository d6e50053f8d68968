#pragma once
// A fast digest for detecting damage, not forgery; the SHA-256 in the manifest is for that.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace echocine {

// Four lanes of 64 bits. Each takes every fourth word by a step that is bijective in both word and
// lane, so bytes that differ within one 8-byte word always have different digests.
class Digest {
 public:
  // Precondition: all pieces except the last are multiples of 32 bytes.
  void update(std::span<const std::byte> bytes);
  std::string hex();  // kDigits digits; call once, at the end

  static constexpr std::size_t kDigits = 64;

 private:
  std::array<std::uint64_t, 4> lanes_{0x9e3779b97f4a7c15ULL, 0xbf58476d1ce4e5b9ULL,
                                      0x94d049bb133111ebULL, 0xd6e8feb86659fd93ULL};
  std::uint64_t size_ = 0;
};

// The digest of all bytes.
std::string digestOfBytes(std::span<const std::byte> bytes);

}  // namespace echocine
