#include "dataset/compressed.h"

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string_view>

#include "core/error.h"

namespace echocine::dataset {

namespace {

using Bytes = std::vector<std::byte>;

constexpr int kLevel = 6;           // zlib's own
constexpr int kRaw = -15;           // window bits: deflate without a header
constexpr int kGzip = 15 + 16;      // the same with gzip's
constexpr std::size_t kMost = 0xf0000000u;

Bytes deflated(std::span<const std::byte> bytes, int window_bits) {
  if (bytes.size() > kMost) throw JobError("over 4 GiB in one file: fewer frames, or smaller ones");
  z_stream stream{};
  constexpr int kMemory = 8;  // zlib's own
  if (deflateInit2(&stream, kLevel, Z_DEFLATED, window_bits, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
    throw JobError("zlib has no memory");
  Bytes out(deflateBound(&stream, bytes.size()));
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int end = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (end != Z_STREAM_END) throw JobError("zlib could not compress");
  return out;
}

template <typename T>
void append(Bytes& to, T value) {
  const std::size_t begin = to.size();
  to.resize(begin + sizeof value);
  std::memcpy(to.data() + begin, &value, sizeof value);
}

void append(Bytes& to, std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
  to.insert(to.end(), bytes.begin(), bytes.end());
}

struct Entry {
  std::string name;
  std::uint32_t crc = 0, packed = 0, whole = 0, at = 0;
};

// What a local header and an entry of the directory share: deflated, 1 January 1980.
void appendCommon(Bytes& to, const Entry& entry) {
  append(to, std::uint16_t{20});    // version that can read it
  append(to, std::uint16_t{0});     // flags
  append(to, std::uint16_t{8});     // deflated
  append(to, std::uint16_t{0});     // midnight
  append(to, std::uint16_t{0x21});  // 1 January 1980
  append(to, entry.crc);
  append(to, entry.packed);
  append(to, entry.whole);
  append(to, static_cast<std::uint16_t>(entry.name.size()));
  append(to, std::uint16_t{0});  // no extra field
}

void appendDirectoryEntry(Bytes& to, const Entry& entry) {
  append(to, std::uint32_t{0x02014b50});
  append(to, std::uint16_t{20});
  appendCommon(to, entry);
  for (int i = 0; i < 3; ++i) append(to, std::uint16_t{0});  // comment, disk, internal attributes
  append(to, std::uint32_t{0});                              // external attributes
  append(to, entry.at);
  append(to, std::string_view(entry.name));
}

}  // namespace

std::vector<std::byte> gzipped(std::span<const std::byte> bytes) {
  return deflated(bytes, kGzip);
}

std::vector<std::byte> compressedNpz(std::span<const NamedArray> arrays) {
  Bytes file, directory;
  for (const NamedArray& array : arrays) {
    const Bytes packed = deflated(array.npy, kRaw);
    if (file.size() + packed.size() > kMost) throw JobError("over 4 GiB in one .npz: fewer frames");
    const auto crc = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(array.npy.data()),
              static_cast<uInt>(array.npy.size())));
    const Entry entry{array.name + ".npy", crc, static_cast<std::uint32_t>(packed.size()),
                      static_cast<std::uint32_t>(array.npy.size()),
                      static_cast<std::uint32_t>(file.size())};
    append(file, std::uint32_t{0x04034b50});
    appendCommon(file, entry);
    append(file, std::string_view(entry.name));
    file.insert(file.end(), packed.begin(), packed.end());
    appendDirectoryEntry(directory, entry);
  }
  const auto start = static_cast<std::uint32_t>(file.size());
  file.insert(file.end(), directory.begin(), directory.end());
  append(file, std::uint32_t{0x06054b50});
  append(file, std::uint32_t{0});  // disks
  append(file, static_cast<std::uint16_t>(arrays.size()));
  append(file, static_cast<std::uint16_t>(arrays.size()));
  append(file, static_cast<std::uint32_t>(directory.size()));
  append(file, start);
  append(file, std::uint16_t{0});  // comment
  return file;
}

}  // namespace echocine::dataset
