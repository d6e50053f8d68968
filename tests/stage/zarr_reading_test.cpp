// Zarr stores by the published layouts, written here byte by byte; and stores that are wrong.

#include <gtest/gtest.h>
#include <zlib.h>
#include <zstd.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core/error.h"
#include "support/damaged_file.h"
#include "zarr/zarr_input.h"
#include "zarr/zarr_store.h"

namespace echocine {
namespace {

using namespace support;
using Json = nlohmann::json;
namespace fs = std::filesystem;

// 5 x 4 x 3, in chunks of 2 x 3 x 3: those at the ends reach beyond the array.
const std::vector<std::size_t> kZarrShape{5, 4, 3}, kZarrChunk{2, 3, 3};

std::vector<float> countedValues() {
  std::vector<float> values(60);
  std::iota(values.begin(), values.end(), 1.0f);
  return values;
}

std::string chunkBytes(std::size_t a, std::size_t b) {
  std::string bytes;
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t x = 2 * a + i, y = 3 * b + j;
        const float value = x < 5 && y < 4 ? static_cast<float>(1 + (x * 4 + y) * 3 + k) : -7;
        char four[4];
        std::memcpy(four, &value, 4);
        bytes.append(four, 4);
      }
  return bytes;
}

std::string deflatedBytes(const std::string& bytes, int window) {
  z_stream stream{};
  deflateInit2(&stream, 6, Z_DEFLATED, window, 8, Z_DEFAULT_STRATEGY);
  std::string out(4096, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

std::string encodedBytes(const std::string& codec, const std::string& bytes) {
  if (codec == "zlib") return deflatedBytes(bytes, 15);
  if (codec == "gzip") return deflatedBytes(bytes, 31);
  if (codec != "zstd") return bytes;
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 3));
  return out;
}

// The CRC-32C of RFC 3720 by its polynomial division, highest bit first after reflection.
std::string crcOf(const std::string& bytes) {
  std::uint32_t crc = 0xffffffffU;
  for (const char c : bytes)
    for (int bit = 0; bit < 8; ++bit) {
      const bool one =
          (((crc ^ (static_cast<std::uint32_t>(static_cast<unsigned char>(c)) >> bit)) & 1U) != 0);
      crc = (crc >> 1) ^ (one ? 0x82f63b78U : 0U);
    }
  crc = ~crc;
  char four[4];
  std::memcpy(four, &crc, 4);
  return {four, 4};
}

Json metadata2(const std::string& codec) {
  return {{"zarr_format", 2},
          {"shape", kZarrShape},
          {"chunks", kZarrChunk},
          {"dtype", "<f4"},
          {"fill_value", nullptr},
          {"order", "C"},
          {"filters", nullptr},
          {"compressor", codec == "none" ? Json() : Json{{"id", codec}, {"level", 1}}}};
}

Json metadata3(const std::string& codec) {
  Json codecs = Json::array({{{"name", "bytes"}, {"configuration", {{"endian", "little"}}}}});
  if (codec != "none") codecs.push_back({{"name", codec}, {"configuration", {{"level", 1}}}});
  codecs.push_back({{"name", "crc32c"}});
  return {{"zarr_format", 3},
          {"node_type", "array"},
          {"shape", kZarrShape},
          {"data_type", "float32"},
          {"chunk_grid", {{"name", "regular"}, {"configuration", {{"chunk_shape", kZarrChunk}}}}},
          {"chunk_key_encoding", {{"name", "default"}, {"configuration", {{"separator", "/"}}}}},
          {"fill_value", "NaN"},
          {"codecs", codecs}};
}

// A store with the array data/values.
fs::path storeOf(const fs::path& folder, int version, const std::string& codec) {
  const fs::path array = folder / "data/values";
  if (version == 2) {
    writeBytes(folder / ".zgroup", R"({"zarr_format": 2})");
    writeBytes(folder / ".zattrs", R"({"word": "here"})");
    writeBytes(array / ".zarray", metadata2(codec).dump());
  } else {
    writeBytes(folder / "zarr.json",
               R"({"zarr_format": 3, "node_type": "group", "attributes": {"word": "here"}})");
    writeBytes(array / "zarr.json", metadata3(codec).dump());
  }
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 2; ++b) {
      const std::string bytes = encodedBytes(codec, chunkBytes(a, b));
      const std::string key =
          version == 2 ? fmt::format("{}.{}.0", a, b) : fmt::format("c/{}/{}/0", a, b);
      writeBytes(array / key, version == 2 ? bytes : bytes + crcOf(bytes));
    }
  return folder;
}

std::string zarrRefusal(const fs::path& store) {
  try {
    ZarrInput(store).numbers("data/values", 1000);
  } catch (const SceneError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.what();
  }
  return "";
}

TEST(ZarrReading, EveryVersionAndCodecGivesTheValues) {
  const std::vector<float> values = countedValues();
  for (const int version : {2, 3})
    for (const std::string codec : {"none", "zlib", "gzip", "zstd"}) {
      SCOPED_TRACE(fmt::format("version {}, {}", version, codec));
      const TempFolder folder;
      const ZarrInput store(storeOf(folder / "s.zarr", version, codec));
      EXPECT_EQ(store.attributes().at("word"), "here");
      const ZarrValues<double> read = store.numbers("data/values", 60);
      EXPECT_EQ(read.shape, kZarrShape);
      EXPECT_EQ(read.absent_chunks, 0u);
      EXPECT_TRUE(std::equal(values.begin(), values.end(), read.values.begin(), read.values.end(),
                             [](float a, double b) { return static_cast<double>(a) == b; }));
    }
}

TEST(ZarrReading, OurOwnStoreComesBack) {
  const TempFolder folder;
  const std::vector<float> floats = countedValues();
  std::vector<std::uint8_t> bytes(60);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{100});
  const std::vector<ZarrArray> arrays{{"data/bytes", kZarrShape, bytes},
                                      {"more/times", {60}, floats}};
  writeZarr(folder / "s.zarr", {{"word", "here"}}, arrays);
  const ZarrInput store(folder / "s.zarr");
  EXPECT_EQ(store.bytes("data/bytes", 60).values, bytes);
  EXPECT_EQ(store.numbers("more/times", 60).values,
            std::vector<double>(floats.begin(), floats.end()));
  EXPECT_THROW(store.bytes("more/times", 60), SceneError);
  EXPECT_THROW(store.bytes("data/bytes", 59), SceneError);
}

TEST(ZarrReading, AbsentChunksHaveTheFillValue) {
  const TempFolder folder;
  storeOf(folder / "s.zarr", 3, "zstd");
  fs::remove(folder / "s.zarr/data/values/c/0/0/0");
  const ZarrValues<double> read = ZarrInput(folder / "s.zarr").numbers("data/values", 60);
  EXPECT_EQ(read.absent_chunks, 1u);
  EXPECT_TRUE(std::isnan(read.values.front()));
  EXPECT_EQ(read.values.back(), 60);
}

// Each change of the metadata, and a part of the answer.
TEST(ZarrReading, UnsupportedAndAbsurdMetadataAreRefusedByName) {
  const std::pair<Json, const char*> changes[] = {
      {{{"compressor", {{"id", "blosc"}, {"cname", "lz4"}}}}, "codec blosc"},
      {{{"compressor", {{"id", "lz4\n\x01"}}}}, "codec lz4??"},
      {{{"compressor", 7}}, "id is absent"},
      {{{"filters", Json::array({{{"id", "delta"}}})}}, "delta"},
      {{{"order", "F"}}, "order: F"},
      {{{"dtype", ">f4"}}, ">f4"},
      {{{"dtype", Json::array({1})}}, "type [1]"},
      {{{"shape", Json::array()}}, "shape"},
      {{{"shape", {5, 4, 0}}}, "shape: 0"},
      {{{"shape", {5, -4, 3}}}, "shape: -4"},
      {{{"shape", {5, 4.5, 3}}}, "shape: 4.5"},
      {{{"shape", {4294967296, 4294967296, 4294967296}}}, "shape: more than"},
      {{{"shape", {1000, 1, 3}}, {"chunks", {1, 1, 3}}}, "accepted: up to 1000"},
      {{{"chunks", {2, 3}}}, "2 sides for 3 axes"},
      {{{"chunks", {100000, 100000, 3}}}, "chunks: more than"},
      {{{"fill_value", "x"}}, "fill_value: x"},
      {{{"zarr_format", 3}}, "zarr_format is not 2"},
      {{{"dimension_separator", ".."}}, "dimension_separator: .."}};
  for (const auto& [change, part] : changes) {
    const TempFolder folder;
    storeOf(folder / "s.zarr", 2, "none");
    Json metadata = metadata2("none");
    metadata.update(change);
    writeBytes(folder / "s.zarr/data/values/.zarray", metadata.dump());
    const std::string said = zarrRefusal(folder / "s.zarr");
    EXPECT_NE(said.find(part), std::string::npos) << part << ": " << said;
  }
  const TempFolder folder;
  storeOf(folder / "s.zarr", 3, "none");
  Json metadata = metadata3("none");
  metadata["codecs"] = Json::array({{{"name", "sharding_indexed"}}});
  writeBytes(folder / "s.zarr/data/values/zarr.json", metadata.dump());
  EXPECT_NE(zarrRefusal(folder / "s.zarr").find("sharding_indexed"), std::string::npos);
  writeBytes(folder / "s.zarr/data/values/zarr.json", std::string(100000, '['));
  EXPECT_NE(zarrRefusal(folder / "s.zarr").find("no JSON object"), std::string::npos);
}

TEST(ZarrReading, NoNameLeadsOutOfTheStore) {
  const TempFolder folder;
  storeOf(folder / "s.zarr", 2, "none");
  storeOf(folder / "other.zarr", 2, "none");
  const ZarrInput store(folder / "s.zarr");
  for (const std::string name : {"../other.zarr/data/values", "data/../../other.zarr/data/values",
                                 "/etc", "", ".", "data//..", "data/./values"})
    EXPECT_THROW(store.numbers(name, 60), SceneError) << name;
  fs::create_directory_symlink(folder / "other.zarr/data", folder / "s.zarr/linked");
  EXPECT_THROW(store.numbers("linked/values", 60), SceneError);
  fs::remove(folder / "s.zarr/data/values/0.0.0");
  fs::create_symlink("/dev/zero", folder / "s.zarr/data/values/0.0.0");
  EXPECT_THROW(store.numbers("data/values", 60), SceneError);
}

// A chunk that is damaged is refused, or has other values where nothing checks them. It never
// gives another shape.
TEST(ZarrReading, DamagedStoresEndInOneLine) {
  for (const int version : {2, 3})
    for (const std::string codec : {"none", "zlib", "gzip", "zstd"}) {
      const TempFolder folder;
      const fs::path store = storeOf(folder / "s.zarr", version, codec);
      std::vector<fs::path> files;
      for (const auto& entry : fs::recursive_directory_iterator(store))
        if (entry.is_regular_file()) files.push_back(entry.path());
      std::sort(files.begin(), files.end());
      int refused = 0, with_crc = 0;
      for (const fs::path& file : files) {
        const std::string whole = bytesOf(file);
        const bool chunk = file.filename().string().find("zarr") == std::string::npos &&
                           file.filename().string()[0] != '.';
        for (std::uint64_t seed = 0; seed < 24; ++seed) {
          const std::string changed = damaged(whole, seed);
          writeBytes(file, changed);
          const bool said = !zarrRefusal(store).empty();
          refused += said ? 1 : 0;
          if (version == 3 && chunk && changed != whole) {
            EXPECT_TRUE(said) << file << " " << seed;
            ++with_crc;
          }
        }
        writeBytes(file, whole);
      }
      EXPECT_GT(refused, 40);
      EXPECT_TRUE(version == 2 || with_crc > 100);
      EXPECT_EQ(zarrRefusal(store), "");
    }
}

// A small file that inflates to more than its chunk.
TEST(ZarrReading, ChunksInflateToTheirSizeOnly) {
  for (const std::string codec : {"zlib", "gzip", "zstd"}) {
    const TempFolder folder;
    const fs::path store = storeOf(folder / "s.zarr", 2, codec);
    for (const std::size_t size : {std::size_t{71}, std::size_t{73}, std::size_t{1} << 20}) {
      writeBytes(store / "data/values/0.0.0", encodedBytes(codec, std::string(size, '\0')));
      EXPECT_NE(zarrRefusal(store), "") << codec << " " << size;
    }
    writeBytes(store / "data/values/0.0.0", std::string(1 << 20, '\0'));
    EXPECT_NE(zarrRefusal(store).find("too many"), std::string::npos);
  }
}

}  // namespace
}  // namespace echocine
