#pragma once
// HDF5 files of a few arrays, with deterministic bytes (https://www.hdfgroup.org).

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace echocine::dataset {

// In C order: the last dimension runs fastest.
struct Hdf5Array {
  std::string name;
  std::vector<std::size_t> shape;
  std::variant<std::span<const std::uint8_t>, std::span<const float>> values;
};

// A complete file, without times. Bytes are compressed, floats are not. Thread-safe. Throws
// JobError.
std::vector<std::byte> hdf5Bytes(std::span<const Hdf5Array> arrays);

}  // namespace echocine::dataset
