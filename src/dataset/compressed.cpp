#include "dataset/compressed.h"

#include <zlib.h>

#include "core/error.h"
#include "output/zip.h"

namespace echocine::dataset {

namespace {

using Bytes = std::vector<std::byte>;

constexpr int kLevel = 6;       // zlib's own
constexpr int kRaw = -15;       // window bits: deflate without a header
constexpr int kGzip = 15 + 16;  // the same with gzip's
constexpr std::size_t kMost = 0xf0000000u;

Bytes deflated(std::span<const std::byte> bytes, int window_bits) {
  if (bytes.size() > kMost) throw JobError("a file exceeds 4 GiB: use fewer or smaller frames");
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

}  // namespace

std::vector<std::byte> gzipped(std::span<const std::byte> bytes) {
  return deflated(bytes, kGzip);
}

std::vector<std::byte> compressedNpz(std::span<const NamedArray> arrays) {
  std::vector<Bytes> packed;
  for (const NamedArray& array : arrays) packed.push_back(deflated(array.npy, kRaw));
  std::vector<ZipPart> parts;
  for (std::size_t i = 0; i < arrays.size(); ++i)
    parts.push_back({arrays[i].name + ".npy", arrays[i].npy, packed[i], true});
  return zipBytes(parts);
}

}  // namespace echocine::dataset
