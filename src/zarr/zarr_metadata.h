#pragma once
// The metadata of an array in a zarr store: .zarray of version 2, zarr.json of version 3
// (https://zarr-specs.readthedocs.io). Checked as input that may be malicious.

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace echocine {

// Limits; our choice. A larger array is refused before memory is taken.
inline constexpr std::size_t kMostZarrValues = std::size_t{1} << 28;
inline constexpr std::size_t kMostZarrChunks = std::size_t{1} << 20;
inline constexpr std::size_t kMostZarrChunkBytes = std::size_t{1} << 28;
inline constexpr std::size_t kMostZarrRank = 8;

enum class ZarrType { uint8, float32, float64 };  // little endian

enum class ZarrCodec { gzip, zlib, zstd, crc32c };

struct ZarrLayout {
  std::vector<std::size_t> shape, chunk;  // equal ranks, at least one; no side is 0
  ZarrType type = ZarrType::uint8;
  std::vector<ZarrCodec> codecs;  // in the order of writing; read in reverse
  double fill = 0;                // of absent chunks
  std::string prefix;             // of a chunk's key: "" or "c/"
  char separator = '.';           // between its indices

  std::size_t valueBytes() const;
  std::size_t values() const;             // of the array
  std::size_t chunkValues() const;        // of each chunk, those at the end too
  std::vector<std::size_t> grid() const;  // chunks along each axis
};

// From the text of .zarray or zarr.json. `name` is used in messages. Throws SceneError: JSON that
// is none, another type of number, order or codec (by its name), sizes beyond the limits.
ZarrLayout zarrLayout(std::string_view text, int version, const std::string& name);

// Text to JSON; throws SceneError for text that is no object, or nested more deeply than 64.
nlohmann::json zarrJson(std::string_view text, const std::string& name);

}  // namespace echocine
