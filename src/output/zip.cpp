#include "output/zip.h"

#include <array>
#include <cstdint>

#include "core/error.h"

namespace echocine {

namespace {

using Bytes = std::vector<std::byte>;

// CRC-32 of ISO 3309, bit-reversed, as zip has it.
std::uint32_t crc32(std::span<const std::byte> bytes) {
  static const std::array<std::uint32_t, 256> kTable = [] {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t i = 0; i < table.size(); ++i) {
      std::uint32_t c = i;
      for (int bit = 0; bit < 8; ++bit) c = (c & 1u) != 0 ? 0xedb88320u ^ (c >> 1) : c >> 1;
      table[i] = c;
    }
    return table;
  }();
  std::uint32_t crc = 0xffffffffu;
  for (const std::byte b : bytes)
    crc = kTable[(crc ^ std::to_integer<std::uint32_t>(b)) & 0xffu] ^ (crc >> 8);
  return ~crc;
}

// What a local header and an entry of the directory share.
void appendCommon(Bytes& to, const ZipPart& part, std::uint32_t crc) {
  append(to, std::uint16_t{20});  // version that can read it
  append(to, std::uint16_t{0});   // flags
  append(to, static_cast<std::uint16_t>(part.deflated ? 8 : 0));
  append(to, std::uint16_t{0});     // midnight
  append(to, std::uint16_t{0x21});  // 1 January 1980
  append(to, crc);
  append(to, static_cast<std::uint32_t>(part.packed.size()));
  append(to, static_cast<std::uint32_t>(part.whole.size()));
  append(to, static_cast<std::uint16_t>(part.name.size()));
  append(to, std::uint16_t{0});  // no extra field
}

}  // namespace

std::vector<std::byte> zipBytes(std::span<const ZipPart> parts) {
  Bytes file, directory;
  for (const ZipPart& part : parts) {
    if (file.size() + part.packed.size() > 0xf0000000u)
      throw JobError("the arrays are over 4 GiB, which no .npz holds: fewer tracks or frames");
    const std::uint32_t crc = crc32(part.whole);
    append(directory, std::uint32_t{0x02014b50});
    append(directory, std::uint16_t{20});
    appendCommon(directory, part, crc);
    append(directory, std::uint16_t{0});  // comment
    append(directory, std::uint16_t{0});  // disk
    append(directory, std::uint16_t{0});  // internal attributes
    append(directory, std::uint32_t{0});  // external attributes
    append(directory, static_cast<std::uint32_t>(file.size()));
    append(directory, std::string_view(part.name));
    append(file, std::uint32_t{0x04034b50});
    appendCommon(file, part, crc);
    append(file, std::string_view(part.name));
    file.insert(file.end(), part.packed.begin(), part.packed.end());
  }
  const auto start = static_cast<std::uint32_t>(file.size());
  file.insert(file.end(), directory.begin(), directory.end());
  append(file, std::uint32_t{0x06054b50});
  append(file, std::uint32_t{0});  // disks
  append(file, static_cast<std::uint16_t>(parts.size()));
  append(file, static_cast<std::uint16_t>(parts.size()));
  append(file, static_cast<std::uint32_t>(directory.size()));
  append(file, start);
  append(file, std::uint16_t{0});  // comment
  return file;
}

}  // namespace echocine
