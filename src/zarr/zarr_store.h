#pragma once
// Zarr version 2 in a folder (https://zarr-specs.readthedocs.io, "Zarr storage specification
// version 2"): arrays with a chunk per step of the first axis.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace echocine {

// In C order.
struct ZarrArray {
  std::string path;  // such as "data/ecg"
  std::vector<std::size_t> shape;
  std::variant<std::span<const std::uint8_t>, std::span<const float>> values;
};

// Writes a new store: root attributes, groups and arrays. Chunks are compressed by zlib; arrays of
// one axis have a single chunk. Values are little endian. Precondition: `folder` does not exist.
// Throws JobError. Files are neither synced nor renamed; the caller gives the folder its name.
void writeZarr(const std::filesystem::path& folder, const nlohmann::ordered_json& attributes,
               std::span<const ZarrArray> arrays);

}  // namespace echocine
