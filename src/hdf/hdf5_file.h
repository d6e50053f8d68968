#pragma once
// HDF5 files of a few arrays, with deterministic bytes (https://www.hdfgroup.org).

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace echocine {

// In C order: the last dimension runs fastest. A text and an empty shape are one value.
struct Hdf5Array {
  std::string name;  // with its groups: "metadata/ecg/samples"
  std::vector<std::size_t> shape;
  std::variant<std::span<const std::uint8_t>, std::span<const float>, std::string> values;
  bool compressed = false;  // a chunk for each place of the first dimension
};

// A text attribute of the root group.
struct Hdf5Attribute {
  std::string name, text;
};

// A complete file, without times. Thread-safe. Throws JobError.
std::vector<std::byte> hdf5Bytes(std::span<const Hdf5Array> arrays,
                                 std::span<const Hdf5Attribute> attributes = {});

}  // namespace echocine
