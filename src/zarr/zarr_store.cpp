#include "zarr/zarr_store.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "core/check.h"
#include "core/error.h"
#include "core/file.h"
#include "core/stop.h"

namespace echocine {

namespace fs = std::filesystem;

namespace {

using Json = nlohmann::ordered_json;

constexpr int kLevel = 6;  // zlib's own

void writeText(const fs::path& file, const Json& json) {
  const std::string text = json.dump(1);
  writeNewFile(file, std::as_bytes(std::span(text)));
}

std::vector<std::byte> deflated(std::span<const std::byte> bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::byte> out(size);
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()),
                kLevel) != Z_OK)
    throw JobError("zlib could not compress a chunk");
  out.resize(size);
  return out;
}

void writeArray(const fs::path& store, const ZarrArray& array) {
  const bool floats = std::holds_alternative<std::span<const float>>(array.values);
  const std::span<const std::byte> bytes =
      std::visit([](const auto& values) { return std::as_bytes(values); }, array.values);
  std::size_t count = floats ? sizeof(float) : 1;
  for (const std::size_t side : array.shape) count *= side;
  CHECK_EQ(count, bytes.size());
  std::vector<std::size_t> chunk = array.shape;
  if (chunk.size() > 1) chunk.front() = 1;
  for (std::size_t& side : chunk) side = std::max<std::size_t>(side, 1);
  const fs::path folder = store / array.path;
  makeFolder(folder);
  writeText(folder / ".zarray", {{"zarr_format", 2},
                                 {"shape", array.shape},
                                 {"chunks", chunk},
                                 {"dtype", floats ? "<f4" : "|u1"},
                                 {"compressor", {{"id", "zlib"}, {"level", kLevel}}},
                                 {"fill_value", 0},
                                 {"order", "C"},
                                 {"filters", nullptr}});
  const std::size_t chunks = array.shape.size() > 1 ? array.shape.front() : 1;
  std::string rest;
  for (std::size_t i = 1; i < array.shape.size(); ++i) rest += ".0";
  for (std::size_t i = 0; i < chunks && !bytes.empty(); ++i) {
    checkpoint();
    const std::size_t size = bytes.size() / chunks;
    writeNewFile(folder / (std::to_string(i) + rest), deflated(bytes.subspan(i * size, size)));
  }
}

}  // namespace

void writeZarr(const fs::path& folder, const Json& attributes, std::span<const ZarrArray> arrays) {
  const Json group{{"zarr_format", 2}};
  makeFolder(folder);
  writeText(folder / ".zgroup", group);
  writeText(folder / ".zattrs", attributes);
  std::set<fs::path> groups;
  for (const ZarrArray& array : arrays) groups.insert(fs::path(array.path).parent_path());
  for (const fs::path& name : groups) {
    makeFolder(folder / name);
    writeText(folder / name / ".zgroup", group);
  }
  for (const ZarrArray& array : arrays) writeArray(folder, array);
}

}  // namespace echocine
