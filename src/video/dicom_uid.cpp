#include "video/dicom_uid.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/hash.h"

namespace echocine {

namespace {

using Uuid = std::array<unsigned, 16>;  // bytes, the most significant first

Uuid uuidOf(std::string_view text) {
  Sha256 hash;
  hash.update(text);
  const std::string hex = hash.hex();
  Uuid uuid{};
  for (std::size_t i = 0; i < uuid.size(); ++i)
    std::from_chars(hex.data() + 2 * i, hex.data() + 2 * i + 2, uuid[i], 16);
  uuid[6] = (uuid[6] & 0x0f) | 0x80;  // version 8
  uuid[8] = (uuid[8] & 0x3f) | 0x80;  // variant of RFC 9562
  return uuid;
}

}  // namespace

// Long division by 10, one digit at a time.
std::string dicomUid(std::string_view text) {
  Uuid number = uuidOf(text);
  std::string digits;
  while (std::any_of(number.begin(), number.end(), [](unsigned byte) { return byte != 0; })) {
    unsigned rest = 0;
    for (unsigned& byte : number) {
      const unsigned part = 256 * rest + byte;
      byte = part / 10;
      rest = part % 10;
    }
    digits += static_cast<char>('0' + rest);
  }
  std::reverse(digits.begin(), digits.end());
  return "2.25." + digits;
}

}  // namespace echocine
