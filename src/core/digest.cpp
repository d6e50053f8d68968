#include "core/digest.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "core/hash_random.h"

namespace echocine {

namespace {

constexpr std::size_t kStripe = 32;

// An odd factor and a rotation: both one to one.
std::uint64_t fed(std::uint64_t lane, std::uint64_t word) {
  return std::rotl((lane ^ word) * 0xff51afd7ed558ccdULL, 31);
}

}  // namespace

void Digest::update(std::span<const std::byte> bytes) {
  size_ += bytes.size();
  std::array<std::uint64_t, 4> words{}, lanes = lanes_;
  for (; bytes.size() >= kStripe; bytes = bytes.subspan(kStripe)) {
    std::memcpy(words.data(), bytes.data(), kStripe);
    for (std::size_t i = 0; i < 4; ++i) lanes[i] = fed(lanes[i], words[i]);
  }
  if (!bytes.empty()) {  // the last piece, filled up with zeros; its size is in the end
    words = {};
    std::memcpy(words.data(), bytes.data(), bytes.size());
    for (std::size_t i = 0; i < 4; ++i) lanes[i] = fed(lanes[i], words[i]);
  }
  lanes_ = lanes;
}

std::string Digest::hex() {
  std::string text;
  // Each lane stays one to one while it takes up the others.
  for (int round = 0; round < 2; ++round)
    for (std::size_t i = 0; i < 4; ++i)
      lanes_[i] = mixBits(lanes_[i] ^ std::rotl(lanes_[(i + 3) % 4], 17) ^ size_);
  for (const std::uint64_t lane : lanes_) text += fmt::format("{:016x}", lane);
  return text;
}

std::string digestOfBytes(std::span<const std::byte> bytes) {
  Digest digest;
  digest.update(bytes);
  return digest.hex();
}

}  // namespace echocine
