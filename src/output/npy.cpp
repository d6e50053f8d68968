#include "output/npy.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>

#include "core/check.h"
#include "core/error.h"

namespace echocine {

namespace {

static_assert(std::endian::native == std::endian::little);

using Bytes = std::vector<std::byte>;

void append(Bytes& to, std::string_view text) {
  const std::size_t begin = to.size();
  to.resize(begin + text.size());
  std::memcpy(to.data() + begin, text.data(), text.size());
}

template <typename T>
void append(Bytes& to, const T& value) {
  append(to, std::string_view(reinterpret_cast<const char*>(&value), sizeof value));
}

// numpy.lib.format, version 1.0: the header ends with a line feed on a multiple of 64 bytes.
Bytes npyOf(const char* type, std::span<const std::byte> values,
            const std::vector<std::size_t>& shape) {
  std::string places;
  for (const std::size_t n : shape) places += fmt::format("{}, ", n);
  std::string header =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, places);
  constexpr std::size_t kPrefix = 10, kUnit = 64;
  header.append(kUnit - (kPrefix + header.size() + 1) % kUnit, ' ');
  header += '\n';
  Bytes bytes;
  append(bytes, std::string_view("\x93NUMPY\x01\x00", 8));
  append(bytes, static_cast<std::uint16_t>(header.size()));
  append(bytes, std::string_view(header));
  bytes.insert(bytes.end(), values.begin(), values.end());
  return bytes;
}

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

// What a local header and an entry of the directory share: stored, 1 January 1980.
void appendCommon(Bytes& to, const NamedArray& array, std::uint32_t crc) {
  const auto size = static_cast<std::uint32_t>(array.npy.size());
  append(to, std::uint16_t{20});  // version that can read it
  append(to, std::uint16_t{0});   // flags
  append(to, std::uint16_t{0});   // stored
  append(to, std::uint16_t{0});   // midnight
  append(to, std::uint16_t{0x21});
  append(to, crc);
  append(to, size);
  append(to, size);
  append(to, static_cast<std::uint16_t>(array.name.size() + 4));
  append(to, std::uint16_t{0});  // no extra field
}

}  // namespace

std::vector<std::byte> npyBytes(std::span<const float> values, std::vector<std::size_t> shape) {
  return npyOf("<f4", std::as_bytes(values), shape);
}

std::vector<std::byte> npyBytes(std::span<const std::uint8_t> values,
                                std::vector<std::size_t> shape) {
  return npyOf("|u1", std::as_bytes(values), shape);
}

std::vector<std::byte> npyBytes(std::span<const std::int32_t> values,
                                std::vector<std::size_t> shape) {
  return npyOf("<i4", std::as_bytes(values), shape);
}

std::vector<std::byte> npzBytes(std::span<const NamedArray> arrays) {
  Bytes file, directory;
  for (const NamedArray& array : arrays) {
    if (file.size() + array.npy.size() > 0xf0000000u)
      throw JobError("the arrays are over 4 GiB, which no .npz holds: fewer tracks or frames");
    const std::uint32_t crc = crc32(array.npy);
    append(directory, std::uint32_t{0x02014b50});
    append(directory, std::uint16_t{20});
    appendCommon(directory, array, crc);
    append(directory, std::uint16_t{0});  // comment
    append(directory, std::uint16_t{0});  // disk
    append(directory, std::uint16_t{0});  // internal attributes
    append(directory, std::uint32_t{0});  // external attributes
    append(directory, static_cast<std::uint32_t>(file.size()));
    append(directory, std::string_view(array.name + ".npy"));
    append(file, std::uint32_t{0x04034b50});
    appendCommon(file, array, crc);
    append(file, std::string_view(array.name + ".npy"));
    file.insert(file.end(), array.npy.begin(), array.npy.end());
  }
  const auto start = static_cast<std::uint32_t>(file.size());
  file.insert(file.end(), directory.begin(), directory.end());
  append(file, std::uint32_t{0x06054b50});
  append(file, std::uint32_t{0});  // disks
  append(file, static_cast<std::uint16_t>(arrays.size()));
  append(file, static_cast<std::uint16_t>(arrays.size()));
  append(file, static_cast<std::uint32_t>(directory.size()));
  append(file, start);
  append(file, std::uint16_t{0});
  return file;
}

}  // namespace echocine
