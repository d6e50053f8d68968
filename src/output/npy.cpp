#include "output/npy.h"

#include <fmt/format.h>

#include "output/zip.h"

namespace echocine {

namespace {

using Bytes = std::vector<std::byte>;

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

}  // namespace

std::vector<std::byte> npyBytes(std::span<const float> values, std::vector<std::size_t> shape) {
  return npyOf("<f4", std::as_bytes(values), shape);
}

std::vector<std::byte> npyBytes(std::span<const double> values, std::vector<std::size_t> shape) {
  return npyOf("<f8", std::as_bytes(values), shape);
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
  std::vector<ZipPart> parts;
  for (const NamedArray& array : arrays)
    parts.push_back({array.name + ".npy", array.npy, array.npy, false});
  return zipBytes(parts);
}

}  // namespace echocine
