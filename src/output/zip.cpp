#include "output/zip.h"

#include <zlib.h>

#include <cstdint>

#include "core/error.h"

namespace echocine {

namespace {

using Bytes = std::vector<std::byte>;

// The fields that a local header shares with its entry in the directory.
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
      throw JobError(
          "the arrays exceed 4 GiB, the limit of .npz: use fewer tracks, frames or keyframes");
    const auto crc = static_cast<std::uint32_t>(
        crc32_z(0, reinterpret_cast<const Bytef*>(part.whole.data()), part.whole.size()));
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
