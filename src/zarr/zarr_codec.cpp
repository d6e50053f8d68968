#include "zarr/zarr_codec.h"

#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>

#include <cstdint>
#include <cstring>

#include "core/error.h"

namespace echocine {

namespace {

// The most that codecs may add to bytes that do not compress; our choice, above all of their
// bounds.
std::size_t mostEncoded(std::size_t bytes) {
  return bytes + bytes / 64 + 4096;
}

// CRC-32C (Castagnoli), bit by bit reflected: polynomial 0x82f63b78.
std::uint32_t crc32c(std::span<const std::byte> bytes) {
  std::uint32_t crc = 0xffffffffU;
  for (const std::byte byte : bytes) {
    crc ^= static_cast<std::uint32_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (0x82f63b78U & (0U - (crc & 1U)));
  }
  return ~crc;
}

// Inflates to at most `most` bytes. False if the stream is damaged or longer.
bool inflated(std::span<const std::byte> bytes, int window, std::size_t most,
              std::vector<std::byte>& out) {
  z_stream stream{};
  if (inflateInit2(&stream, window) != Z_OK) throw std::bad_alloc();
  out.resize(most + 1);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const int end = inflate(&stream, Z_FINISH);
  const std::size_t size = stream.total_out;
  inflateEnd(&stream);
  out.resize(std::min(size, most));
  return end == Z_STREAM_END && size <= most;
}

bool unzstd(std::span<const std::byte> bytes, std::size_t most, std::vector<std::byte>& out) {
  out.resize(most);
  const std::size_t size = ZSTD_decompress(out.data(), most, bytes.data(), bytes.size());
  if (ZSTD_isError(size) != 0) return false;
  out.resize(size);
  return true;
}

bool withoutCrc(std::vector<std::byte> bytes, std::vector<std::byte>& out) {
  std::uint32_t stored = 0;
  if (bytes.size() < sizeof stored) return false;
  const std::size_t size = bytes.size() - sizeof stored;
  std::memcpy(&stored, bytes.data() + size, sizeof stored);
  if (stored != crc32c(std::span(bytes).first(size))) return false;
  bytes.resize(size);
  out = std::move(bytes);
  return true;
}

}  // namespace

std::vector<std::byte> decodedChunk(const ZarrLayout& layout, std::vector<std::byte> file,
                                    const std::string& name) {
  constexpr int kZlibWindow = 15, kGzipWindow = 15 + 16;
  const std::size_t size = layout.chunkValues() * layout.valueBytes();
  for (auto codec = layout.codecs.rbegin(); codec != layout.codecs.rend(); ++codec) {
    // An inner codec may still have to take something off.
    const std::size_t most = codec + 1 == layout.codecs.rend() ? size : mostEncoded(size);
    std::vector<std::byte> out;
    bool whole = false;
    switch (*codec) {
      case ZarrCodec::gzip:
        whole = inflated(file, kGzipWindow, most, out);
        break;
      case ZarrCodec::zlib:
        whole = inflated(file, kZlibWindow, most, out);
        break;
      case ZarrCodec::zstd:
        whole = unzstd(file, most, out);
        break;
      case ZarrCodec::crc32c:
        whole = withoutCrc(std::move(file), out);
        break;
    }
    if (!whole) throw SceneError(fmt::format("{}: is damaged or cut off", name));
    file = std::move(out);
  }
  if (file.size() != size)
    throw SceneError(fmt::format("{}: holds {} bytes, its chunk has {}", name, file.size(), size));
  return file;
}

}  // namespace echocine
